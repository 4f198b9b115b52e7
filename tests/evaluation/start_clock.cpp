#include "tests/evaluation/start_clock.h"

#include <chrono>

#include "tests/evaluation/visit.h"

namespace framelet::bench {

double start_scene_clock(std::uint16_t port) {
    double start = 0;
    visit(port, coding::exact_colour, [&start](FramedStream& stream, Message const& message) {
        if (std::holds_alternative<Welcome>(message)) {
            stream.send(ClockRequest{ClockRequest::time | ClockRequest::playing, {0, true, 1}});
        } else if (auto const* const status = std::get_if<Status>(&message); status && status->clock.playing) {
            std::chrono::duration<double> const now = std::chrono::system_clock::now().time_since_epoch();
            start = now.count() - status->clock.time;
            return true;
        }
        return false;
    });
    return start;
}

} // namespace framelet::bench
