// The words of the overlay. In: statistics now and a moment ago. Out: rows of text.
#pragma once

#include <chrono>

#include "client/core/client_core.h"
#include "client/window/overlay.h"

namespace framelet {

/// Display frames and bytes of the last second or so.
class RateMeter {
public:
    /// A display frame was shown, which took so long to make.
    void frame(double seconds_taken);
    /// Closes the interval where it is at least half a second old; true when the figures are new.
    bool update(double now_seconds, std::uint64_t bytes);

    double frames_per_second() const { return frames_per_second_; }
    double frame_seconds() const { return frame_seconds_; } ///< mean
    double bytes_per_second() const { return bytes_per_second_; }

private:
    double start_ = 0;
    std::uint64_t start_bytes_ = 0;
    int frames_ = 0;
    double taken_ = 0;
    double frames_per_second_ = 0;
    double frame_seconds_ = 0;
    double bytes_per_second_ = 0;
};

/// What is said where another viewer has the scene's clock at its disposal.
inline constexpr char const* watching_text = "another viewer controls the scene's clock";

/// `controls`: the keys that set the scene's clock have an effect.
TextRows help_rows(bool controls);
TextRows statistics_rows(ClientStatistics const& statistics, RateMeter const& meter, ClockState const& clock,
                         bool controls, Viewport viewport);
/// "12.34 s, playing at 1x".
std::string clock_text(ClockState const& clock);
/// "the scene 100 ms late".
std::string lag_text(double lag_seconds);

} // namespace framelet
