// Chooses which moment is rendered: few of them, since a viewer that moves what it holds loses little by a moment that
// is a little old, and pays for every one that its picture is made of. In: what is to be seen. Out: what is rendered of
// it.
#pragma once

#include <optional>

#include "server/sampling/plan/view_state.h"

namespace framelet {

/// While anything moves a moment lasts until the next multiple of this, seconds: viewers of one scene change together.
inline constexpr double moment_seconds = 0.1;
/// Seconds after which a picture that has stayed as it is counts as at rest: longer than a slow display's frame.
inline constexpr double rest_seconds = 0.05;

class MomentChoice {
public:
    explicit MomentChoice(double seconds = moment_seconds) : seconds_(seconds) {}

    /// Takes in what is to be seen at present. True when another moment is to `begin` now: the last one has lasted long
    /// enough, the picture has another size, projection or exposure, or something begins to move. Never at rest, nor
    /// for a viewer that moves nothing. `now`: seconds, steady.
    bool observe(ViewState const& present, double now, bool viewer_moves_samples);
    void begin(HeldMoment const& moment) { held_ = moment; }
    /// The moment to render; nothing where the present is.
    std::optional<HeldMoment> const& held() const { return held_; }
    /// Ends the moment that is held, so that the next begins anew, as after the scene's clock was set.
    void forget() { held_.reset(); }

private:
    bool goes_on(ViewState const& present, double now) const;

    double seconds_; ///< how long a moment lasts
    std::optional<HeldMoment> held_;
    std::optional<ViewState> last_; ///< present
    double changed_ = 0; ///< when `last_` was last another one, seconds
};

} // namespace framelet
