#include "client/sheet/sheet_moments.h"

#include <chrono>
#include <thread>

#include "common/error.h"

namespace framelet {

namespace {

using Clock = std::chrono::steady_clock;

/// The picture that the view comes to with the clock standing at that moment, or what it is when patience ends; sets
/// whether it is complete. Throws ConnectionError.
Picture still_of(ClientCore& core, ShownMoment const& moment, Viewport viewport, bool sets_clock,
                 std::chrono::seconds patience, bool& complete) {
    // The pictures meanwhile need not be painted: the server may want this machine's processors for what it renders.
    constexpr std::chrono::milliseconds look(200);
    if (sets_clock) {
        core.request_clock({ClockRequest::time | ClockRequest::playing, {moment.time, false, 1}});
    }
    Picture out; // of no size, so that all of it is written
    std::vector<PixelRect> changed;
    bool stands = complete = false;
    for (Clock::time_point const end = Clock::now() + patience; !complete && Clock::now() < end;) {
        core.set_view(moment.camera, viewport, moment.scene_camera);
        core.update_picture(out, changed, Clock::now());
        if (auto const reason = core.end_reason()) {
            throw ConnectionError(*reason);
        }
        // The server's Status of the moment before may still be on its way.
        stands = !sets_clock || core.status().clock.time == moment.time;
        complete = stands && core.is_complete();
        if (!complete) {
            std::this_thread::sleep_for(look);
        }
    }
    if (!stands) {
        throw ConnectionError("the stills of the contact sheet have not come in time");
    }
    core.update_picture(out, changed, Clock::now()); // what came since
    return out;
}

} // namespace

void SheetMoments::note(double seconds, Picture const& shown, ShownMoment const& of) {
    auto const next = static_cast<double>(pairs_.size() + 1);
    if (next <= count && seconds >= run_seconds_ * next / (count + 1)) {
        pairs_.push_back({shown, {}});
        moments_.push_back(of);
    }
}

void SheetMoments::take_stills(ClientCore& core) {
    bool const moves = core.welcome().animation_duration > 0;
    if (pairs_.empty()) {
        return;
    }
    if (moves && !core.controls()) {
        throw InputError("the contact sheet is not written: its stills need the scene's clock, which another viewer "
                         "controls: start the server with --shared-control");
    }
    ClockState const before = core.clock();
    core.set_smoothing(0); // the moment itself is wanted
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
        Picture const& shown = pairs_[i].shown;
        bool complete = false;
        pairs_[i].still = still_of(core, moments_[i], {shown.width, shown.height}, moves, patience_, complete);
        unfinished_ += complete ? 0 : 1;
    }
    if (moves) {
        core.request_clock({ClockRequest::time | ClockRequest::playing, before});
    }
}

double SheetMoments::difference() const {
    if (pairs_.empty()) {
        return -1;
    }
    double sum = 0;
    for (ShownAndStill const& pair : pairs_) {
        sum += mean_difference(pair.shown, pair.still);
    }
    return sum / static_cast<double>(pairs_.size());
}

} // namespace framelet
