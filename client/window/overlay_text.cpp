#include "client/window/overlay_text.h"

#include <iomanip>
#include <sstream>

namespace framelet {

namespace {

constexpr double interval_seconds = 0.5;

std::string fixed(double value, int digits, char const* unit) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(digits) << value << unit;
    return out.str();
}

} // namespace

void RateMeter::frame(double seconds_taken) {
    ++frames_;
    taken_ += seconds_taken;
}

bool RateMeter::update(double now_seconds, std::uint64_t bytes) {
    double const elapsed = now_seconds - start_;
    if (elapsed >= 0 && elapsed < interval_seconds) {
        return false;
    }
    frames_per_second_ = elapsed > 0 ? frames_ / elapsed : 0;
    frame_seconds_ = frames_ > 0 ? taken_ / frames_ : 0;
    bytes_per_second_ = elapsed > 0 && bytes >= start_bytes_ ? static_cast<double>(bytes - start_bytes_) / elapsed : 0;
    start_ = now_seconds;
    start_bytes_ = bytes;
    frames_ = 0;
    taken_ = 0;
    return true;
}

TextRows help_rows(bool controls) {
    TextRows rows{
        {"left drag", "orbit around what is under the pointer"},
        {"middle or Shift+left drag", "pan"},
        {"wheel or right drag", "nearer, farther"},
        {"double click", "look at that point, from half as far"},
        {"F", "the whole scene"},
        {"W A S D, Q E", "fly; down, up (Shift: faster)"},
        {"R", "back to the first view"},
        {"1 .. 9", "camera of the scene"},
        {"0", "free camera from there"},
    };
    TextRows const clock_rows = controls ? TextRows{{"Space", "play, pause"},
                                                    {". and ,", "step by 1/30 s"},
                                                    {"Right and Left", "forward, back by 1 s"},
                                                    {"Home", "animation to its start"},
                                                    {"+ and -", "animation speed"}}
                                         : TextRows{{"Space . , Left Right Home + -", watching_text}};
    rows.insert(rows.end(), clock_rows.begin(), clock_rows.end());
    TextRows const others{
        {"] and [", "brighter, darker by 1/4 EV"},
        {"F2 or Tab", "statistics"},
        {"F3", "outlines of framelets; how old pixels are; neither"},
        {"F4", "move what is held to where it is now, or not"},
        {"F5", "smooth motion, the scene a little late, or not"},
        {"F6", "the time line at the lower edge, or not"},
        {"F11 or Alt+Enter", "full screen"},
        {"F12", "screenshot (PNG, in the current folder)"},
        {"F1", "this help"},
        {"Esc", "quit"},
    };
    rows.insert(rows.end(), others.begin(), others.end());
    return rows;
}

std::string clock_text(ClockState const& clock) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(2) << clock.time << " s, " << (clock.playing ? "playing" : "paused");
    out << std::defaultfloat << " at " << clock.speed << "x";
    return out.str();
}

std::string lag_text(double lag_seconds) {
    return "the scene " + fixed(lag_seconds * 1e3, 0, " ms late");
}

TextRows statistics_rows(ClientStatistics const& s, RateMeter const& meter, ClockState const& clock, bool controls,
                         Viewport viewport) {
    return {
        {"picture", std::to_string(viewport.width) + "x" + std::to_string(viewport.height) + ", covered " +
                        fixed(s.coverage * 100, 0, "%") + (s.converged ? ", converged" : "")},
        {"display", fixed(meter.frames_per_second(), 0, " frames/s, ") + fixed(meter.frame_seconds() * 1e3, 1, " ms")},
        {"network",
         fixed(meter.bytes_per_second() * 8e-6, 2, " Mbit/s, ") + fixed(s.bytes_per_sample(), 2, " B/sample")},
        {"round trip", s.round_trip_seconds < 0 ? "not measured"
                                                : fixed(s.round_trip_seconds * 1e3, 0, " ms (least ") +
                                                      fixed(s.least_round_trip_seconds * 1e3, 0, " ms)")},
        {"server", fixed(s.server_samples_per_second * 1e-6, 2, " Msamples/s")},
        {"received", std::to_string(s.batches) + " batches, " + std::to_string(s.framelets) + " framelets"},
        {"cost",
         fixed(s.decode_ns_per_sample(), 1, " ns/sample, ") + fixed(s.reconstruct_ns_per_pixel(), 1, " ns/pixel")},
        {"cache", std::to_string(s.cached_framelets) + " framelets, " +
                      fixed(static_cast<double>(s.cached_bytes) * 1e-6, 1, " MB")},
        {"clock", clock_text(clock) + (s.lag_seconds > 0 ? "; " + lag_text(s.lag_seconds) : "") +
                      (controls ? "" : std::string("; ") + watching_text)},
    };
}

} // namespace framelet
