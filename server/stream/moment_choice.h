// Which moment is rendered: few of them, since a viewer that moves what it holds loses little by a moment that is a
// little old, and pays for every one that its picture is made of. In: what is to be seen. Out: what is rendered of it.
#pragma once

#include <optional>

#include "server/schedule/view_state.h"

namespace framelet {

/// While anything moves a moment lasts until the next multiple of this, seconds: viewers of one scene change together.
inline constexpr double moment_seconds = 0.1;
/// What has stayed as it is for so long is at rest, seconds: longer than a slow display's frame.
inline constexpr double rest_seconds = 0.05;

class MomentChoice {
public:
    /// The moment to render while things move; nothing where the present is: for a viewer that moves nothing, and at
    /// rest. Begins anew where the picture has another size, projection or exposure, or something begins to move.
    /// `ahead`: what will be to be seen when a moment that begins now is over. `now`: seconds, steady.
    std::optional<HeldMoment> choose(ViewState const& present, ViewState const& ahead, double now,
                                     bool viewer_moves_samples);
    /// The next choice begins a moment: the scene's clock was set.
    void begin_anew() { held_.reset(); }

private:
    bool goes_on(ViewState const& present, double now) const;

    std::optional<HeldMoment> held_;
    std::optional<ViewState> last_; ///< present
    double changed_ = 0; ///< when that was last another one, seconds
};

} // namespace framelet
