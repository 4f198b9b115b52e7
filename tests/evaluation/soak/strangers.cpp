#include "tests/evaluation/soak/strangers.h"

#include <csignal>
#include <optional>
#include <string>

#include "tests/loopback/process.h"
#include "tests/session/raw_viewer.h"

namespace framelet::bench {
namespace {

constexpr int rush_viewers = 12;
constexpr Viewport large{1920, 1080};

CameraUpdate request_of(Viewport viewport) {
    return {{1, Camera{}, viewport}, -1};
}

} // namespace

class Stranger {
public:
    Stranger(StormMoment const& moment, std::uint16_t port, double now)
        : leaves_(now + moment.seconds), stops_(now + 0.5 * moment.seconds),
          is_to_stop_(moment.event == StormEvent::stopped_program) {
        switch (moment.event) {
        case StormEvent::killed_program:
        case StormEvent::stopped_program: {
            std::string const size = moment.chance < 0.5 ? "320x180" : "640x360";
            program_ = std::make_unique<test::Process>(
                FRAMELET_CLIENT, std::vector<std::string>{"127.0.0.1:" + std::to_string(port), "--size", size,
                                                          "--duration", "100", "--no-reconnect"});
            break;
        }
        case StormEvent::slow_reader:
            viewer_.emplace(port);
            viewer_->send(request_of(large));
            break;
        case StormEvent::half_message:
            viewer_.emplace(port);
            viewer_->send(request_of({320, 180}));
            viewer_->send_half(request_of(large));
            break;
        case StormEvent::garbage:
            viewer_.emplace(port);
            viewer_->send(Bytes(std::size_t{1} + static_cast<std::size_t>(1000 * moment.chance), std::byte{0x5a}));
            break;
        case StormEvent::rush:
            for (int i = 0; i < rush_viewers; ++i) {
                RawViewer(port).send(request_of({320, 180}));
            }
            break;
        default:
            break; // the event is a viewer's
        }
    }

    void pass_time(double now) {
        if (is_to_stop_ && now >= stops_) {
            is_to_stop_ = false;
            program_->signal(SIGSTOP);
        }
    }
    bool is_over(double now) const { return now >= leaves_; }

private:
    double const leaves_, stops_;
    bool is_to_stop_;
    std::unique_ptr<test::Process> program_; ///< the stranger's program, which is killed with it
    std::optional<RawViewer> viewer_;
};

Strangers::Strangers(std::uint16_t port) : port_(port) {}
Strangers::~Strangers() = default;

void Strangers::add(StormMoment const& moment, double now) {
    present_.push_back(std::make_unique<Stranger>(moment, port_, now));
}

void Strangers::pass_time(double now) {
    std::erase_if(present_, [now](auto const& stranger) { return stranger->is_over(now); });
    for (auto const& stranger : present_) {
        stranger->pass_time(now);
    }
}

void Strangers::end_all() {
    present_.clear();
}

} // namespace framelet::bench
