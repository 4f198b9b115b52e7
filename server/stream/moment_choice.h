// Chooses which moment is rendered: few of them, since a viewer that moves what it holds loses little by a moment that
// is a little old, and pays for every one that its picture is made of. In: what is to be seen. Out: what is rendered of
// it.
#pragma once

#include <optional>

#include "server/sampling/plan/view_state.h"

namespace framelet {

/// Bounds of how long a moment lasts while anything moves, seconds.
inline constexpr double least_moment_seconds = 0.1, most_moment_seconds = 0.4;

/// How long a moment lasts, seconds, where this much (> 0) is rendered and all of the picture is to be replaced: as few
/// moments as the samples make, since each has seams with the others; but no older than what shows has to be. One of
/// the least length and its doubles, so that viewers who get different shares change together all the same.
double moment_seconds(double samples_per_pixel_and_second);

/// How long a moment lasts, seconds, that is to last so long, where it takes `pose_seconds` to begin it: longer, by
/// doubling, where less than three quarters of that would be left for rendering it.
double worth_posing(double seconds, double pose_seconds);

/// How long a moment lasts at least before a camera that stands, seconds, where there is time for so many.
inline constexpr double least_standing_seconds = 0.05;

/// Seconds after which a picture that has stayed as it is counts as at rest: longer than a slow display's frame.
inline constexpr double rest_seconds = 0.05;
/// The same after the scene's clock was stopped, unless the moment is complete before: what is held is of other times,
/// and what of it shows the present wrongly is rendered first.
inline constexpr double stop_seconds = 0.25;

/// A moment lasts until the next multiple of its length: viewers of one scene change together.
class MomentChoice {
public:
    /// Takes in what is to be seen at present. True when another moment is to `begin` now: the last one has lasted long
    /// enough, the picture has another size, projection or exposure, or something begins to move. Never at rest.
    /// `now`: seconds, steady.
    bool observe(ViewState const& present, double now);
    void begin(HeldMoment const& moment);
    /// Notes that nothing of the moment that is held is worth rendering any more.
    void note_complete(double now);
    /// How long a moment is to last before a camera that stands, seconds: short enough to use the time that there is.
    double standing_seconds() const { return standing_seconds_; }
    /// The moment to render; nothing where the present is.
    std::optional<HeldMoment> const& held() const { return held_; }
    /// Ends the moment that is held, so that the next begins anew.
    void forget() { held_.reset(); }
    /// The same where the scene's clock was set.
    void note_clock_set() {
        forget();
        is_stop_ = true;
    }

private:
    static bool is_near(ViewState const& one, ViewState const& other);
    bool goes_on(ViewState const& present, double now) const;

    std::optional<HeldMoment> held_;
    std::optional<ViewState> last_; ///< present
    double changed_ = 0; ///< when `last_` was last another one, seconds
    bool is_stop_ = false; ///< the scene's clock was set, to about what it was, since the last rest
    std::optional<double> completed_; ///< when the moment that is held was complete, seconds
    double standing_seconds_ = least_moment_seconds;
};

} // namespace framelet
