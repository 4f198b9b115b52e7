#include "tests/evaluation/soak/soak_viewer.h"

#include <array>
#include <cmath>

#include "tests/evaluation/camera_turn.h"

namespace framelet::bench {
namespace {

constexpr std::array<Viewport, 6> sizes{Viewport{64, 48}, {160, 90}, {131, 97}, {320, 180}, {480, 270}, {640, 360}};
constexpr CameraTurn look_around{40, 50};
constexpr std::chrono::milliseconds clock_patience{500}; ///< time until the scene's clock is asked for once more

ConnectionOptions options_of(std::uint16_t port) {
    ConnectionOptions options;
    options.server.port = port;
    options.reconnect = true;
    return options;
}

ClockRequest clock_request(double chance) {
    ClockRequest request;
    request.set = ClockRequest::playing | ClockRequest::speed;
    request.state.playing = chance < 0.8;
    request.state.speed = chance < 0.2 ? -1.0f : 1.0f;
    if (chance > 0.5) {
        request.set |= ClockRequest::time;
        request.state.time = 8 * (chance - 0.5);
    }
    return request;
}

} // namespace

SoakViewer::SoakViewer(std::uint16_t server_port, LinkParameters const& link, Viewport viewport)
    : link_(server_port, link), core_(options_of(link_.port())), viewport_(viewport) {}

void SoakViewer::take(StormMoment const& moment) {
    switch (moment.event) {
    case StormEvent::resize:
        viewport_ = sizes[static_cast<std::size_t>(moment.chance * sizes.size())];
        break;
    case StormEvent::cut:
        link_.cut();
        break;
    case StormEvent::settings:
        settings_ = {static_cast<float>(4 * moment.chance - 2), 0, moment.chance < 0.7};
        core_.set_settings(settings_);
        break;
    case StormEvent::clock:
        core_.request_clock(clock_request(moment.chance));
        break;
    default:
        break; // the event is a stranger's
    }
}

void SoakViewer::move(double now, std::optional<CameraPath> const& flight, int scene_camera) {
    double const there_and_back = flight ? std::abs(std::remainder(now, 2 * flight->duration())) : 0;
    core_.set_view(flight ? flight->at(there_and_back) : turned(start_camera(), look_around, now), viewport_,
                   scene_camera);
    core_.update_picture(picture_, changed_);
}

bool SoakViewer::come_to_rest(StillView const& view) {
    if (settings_ != ViewerSettings{}) {
        settings_ = {};
        core_.set_settings(settings_);
    }
    core_.set_view(view.camera, view.viewport, view.scene_camera);
    ClockState const clock = core_.clock();
    bool const stands = !clock.playing && clock.time == view.time;
    auto const now = std::chrono::steady_clock::now();
    if (!stands && now - clock_asked_ > clock_patience) {
        clock_asked_ = now;
        core_.request_clock({ClockRequest::time | ClockRequest::playing, {view.time, false, 1}});
    }
    bool const complete = stands && core_.is_complete();
    core_.update_picture(picture_, changed_);
    return complete;
}

} // namespace framelet::bench
