// Rays that leave lamps: by them paths find what a lamp lights from near, a spot of a shade or a ceiling, small and far
// brighter than all else ([Veach 1997], bidirectional paths). In: the lights of a scene. Out: rays, and their density.
#pragma once

#include <span>
#include <vector>

#include "server/render/light/light.h"

namespace framelet {

struct LampRay {
    std::uint32_t lamp; ///< number of the light
    Vec3 origin, direction; ///< world; unit
};

class LampRays {
public:
    explicit LampRays(std::span<RenderLight const> lights);

    /// True where no light has a place.
    bool empty() const { return up_to_.empty(); }
    /// A ray of one of the lamps, by their flux. `radius`: of lamps, metres; 0: hard.
    LampRay sample(float choice, Vec2 way, Vec2 aside, float radius) const;
    /// How densely the rays of this lamp meet a surface that faces it, 1 / m^2; 0 where they do not begin yet.
    float density(std::uint32_t lamp, float distance, float radius) const;

private:
    struct Lamp {
        std::uint32_t number;
        Vec3 position, axis; ///< world; unit
        float angle; ///< into which it shines, sr
    };
    std::vector<Lamp> lamps_;
    std::vector<float> up_to_; ///< sums of flux as shares of the total; the last is 1
};

} // namespace framelet
