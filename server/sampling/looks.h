// How fast what surfaces look like changes where they are: a shadow passes, a light goes out. In: what a mirror shows
// of a moment, and new pieces of the very same surfaces. Out: how soon the new ones fade. Motion, of the camera and of
// bodies, is no change: the mirror has moved what it holds.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "server/sampling/mirror.h"

namespace framelet {

class Looks {
public:
    explicit Looks(Viewport viewport = {});

    /// Compares the pieces of a framelet, of the moment that `mirror` looks at, with what it shows there; sets their
    /// `change` and `fading`. Those of another moment (`comparable` false) are told by what is known of around them.
    /// Returns the code of their fading.
    FadingCode learn(Mirror const& mirror, std::span<Piece> pieces, SceneTime scene_time, bool comparable);

    /// Mean squared luma a second of what has been compared lately, anywhere.
    float usual_change() const { return usual_; }

private:
    struct Region {
        float change = 0; ///< mean squared luma a second
        SceneTime when = 0;
    };
    float around(Vec2 at, SceneTime scene_time) const;
    void note(Vec2 at, float change, SceneTime scene_time);

    int columns_, rows_;
    std::vector<Region> regions_; ///< of the picture
    float usual_ = 0;
};

} // namespace framelet
