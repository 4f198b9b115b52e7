#include "server/render/trace/lamp_light.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numeric>
#include <vector>

#include <glm/geometric.hpp>

#include "server/render/light/luminance.h"
#include "server/render/trace/lamp_shadows.h"

namespace framelet {
namespace {

void note_strength(std::uint32_t number, RenderLight const& light, ArrivingLight const& arriving, LaneMask reached,
                   LaneMask blocked, StrongestLight& strongest) {
    float const strength = luminance(light.intensity);
    for_each_lane(reached, [&](int i) {
        float const arrives = strength * arriving.irradiance[i];
        if (arrives > strongest.most[i]) {
            strongest.most[i] = arrives;
            strongest.lost[i] = (blocked >> i & 1) != 0 ? number : no_light;
        }
    });
}

/// Adds what `lit` lanes reflect of a light of which they get these shares; null: all of it.
void add_light(RenderLight const& light, ArrivingLight const& arriving, SurfacePacket const& s, LobePacket const& lobes,
               LaneMask lit, LaneVec3 const* shares, LaneVec3& radiance) {
    LaneVec3 irradiance;
    for (int i = 0; i < lanes; ++i) {
        float const arrives = (lit >> i & 1) != 0 ? arriving.irradiance[i] : 0.0f;
        irradiance.x[i] = light.intensity.r * arrives;
        irradiance.y[i] = light.intensity.g * arrives;
        irradiance.z[i] = light.intensity.b * arrives;
    }
    if (shares != nullptr) {
        for (int i = 0; i < lanes; ++i) {
            irradiance.x[i] *= shares->x[i];
            irradiance.y[i] *= shares->y[i];
            irradiance.z[i] *= shares->z[i];
        }
    }
    add_reflected(lobes, s.normal, s.view, arriving.to_light, irradiance, radiance);
}

/// Adds a light with its shadow.
void add_shadowed(PreparedScene const& scene, std::uint32_t number, SurfacePacket const& s, LobePacket const& lobes,
                  LaneMask lit, bool is_plane, StrongestLight& strongest, LaneVec3& radiance, std::uint32_t& segments) {
    RenderLight const& light = scene.lights[number];
    ArrivingLight arriving;
    LaneMask const reached = arriving_light(light, s.position, s.normal, lit, arriving);
    if (reached == 0) {
        return;
    }
    LaneVec3 passed;
    LaneMask const blocked = find_shadow(scene, light, s, arriving, reached, is_plane, passed, segments);
    if (scene.moves) {
        note_strength(number, light, arriving, reached, blocked, strongest);
    }
    if (LaneMask const bright = reached & ~blocked; bright != 0) {
        add_light(light, arriving, s, lobes, bright, &passed, radiance);
    }
}

/// Lights in the order of what a packet reflects of them, the strongest first as far as these are shadowed one by one.
struct RankedLights {
    std::vector<float> weight; ///< by number: luminance that all lanes together reflect
    std::vector<std::uint32_t> order; ///< numbers
    std::vector<float> sums; ///< of the weights of the others, as far as each
};

/// What would be reflected of a light if nothing were in the way.
LaneVec3 unshadowed(RenderLight const& light, SurfacePacket const& s, LobePacket const& lobes, LaneMask lit) {
    ArrivingLight arriving;
    LaneVec3 radiance;
    radiance.fill(Vec3(0));
    if (LaneMask const reached = arriving_light(light, s.position, s.normal, lit, arriving); reached != 0) {
        add_light(light, arriving, s, lobes, reached, nullptr, radiance);
    }
    return radiance;
}

/// Ranks all lights; sets `all` to what would be reflected if nothing were in the way.
void rank_lights(PreparedScene const& scene, SurfacePacket const& s, LobePacket const& lobes, LaneMask lit,
                 RankedLights& ranked, LaneVec3& all) {
    std::size_t const count = scene.lights.size();
    ranked.weight.assign(count, 0);
    all.fill(Vec3(0));
    for (std::size_t number = 0; number < count; ++number) {
        LaneVec3 const own = unshadowed(scene.lights[number], s, lobes, lit);
        float sum = 0;
        for (int i = 0; i < lanes; ++i) {
            all.x[i] += own.x[i];
            all.y[i] += own.y[i];
            all.z[i] += own.z[i];
            sum += luminance(own.get(i));
        }
        ranked.weight[number] = sum;
    }
    ranked.order.resize(count);
    std::iota(ranked.order.begin(), ranked.order.end(), 0u);
    std::ranges::nth_element(ranked.order, ranked.order.begin() + exact_lights, [&](std::uint32_t a, std::uint32_t b) {
        return std::pair(-ranked.weight[a], a) < std::pair(-ranked.weight[b], b);
    });
    // In the order of the file, so that from packet to packet the same ones are looked at.
    std::sort(ranked.order.begin() + exact_lights, ranked.order.end());
    ranked.sums.clear();
    float sum = 0;
    for (std::size_t i = exact_lights; i < count; ++i) {
        ranked.sums.push_back(sum += ranked.weight[ranked.order[i]]);
    }
}

/// Takes from `rest` what a light would add without its shadow.
void take_away(RenderLight const& light, SurfacePacket const& s, LobePacket const& lobes, LaneMask lit,
               LaneVec3& rest) {
    LaneVec3 const own = unshadowed(light, s, lobes, lit);
    for (int i = 0; i < lanes; ++i) {
        rest.x[i] = std::max(rest.x[i] - own.x[i], 0.0f);
        rest.y[i] = std::max(rest.y[i] - own.y[i], 0.0f);
        rest.z[i] = std::max(rest.z[i] - own.z[i], 0.0f);
    }
}

/// Which lanes of `among` lie near the plane of its first one, turned as that is.
LaneMask lanes_beside_first(SurfacePacket const& s, LaneMask among) {
    int const first = std::countr_zero(among);
    Vec3 const at = s.position.get(first), normal = s.normal.get(first);
    LaneMask beside = 0;
    for_each_lane(among, [&](int i) {
        Vec3 const aside = s.position.get(i) - at;
        bool const is_near = std::abs(glm::dot(aside, normal)) <= 0.3f * glm::length(aside);
        beside |= (is_near && glm::dot(s.normal.get(i), normal) > 0.9f ? 1u : 0u) << i;
    });
    return beside | 1u << first;
}

/// The light to which a lane's ray goes: in proportion to weights. Each lane looks at four quarters of them, and all
/// lanes at 64 parts.
std::uint32_t other_light(RankedLights const& ranked, int lane, int ray) {
    constexpr std::array<float, lanes> part{0, 8, 4, 12, 2, 10, 6, 14, 1, 9, 5, 13, 3, 11, 7, 15};
    float const place = (static_cast<float>(ray) + (part[static_cast<std::size_t>(lane)] + 0.5f) / float{lanes}) /
                        float{rays_to_others};
    auto const found = std::ranges::upper_bound(ranked.sums, place * ranked.sums.back());
    auto const index = std::min<std::ptrdiff_t>(found - ranked.sums.begin(), std::ssize(ranked.sums) - 1);
    return ranked.order[exact_lights + static_cast<std::size_t>(index)];
}

/// Sets `shares` to what share of the others' shine gets to each lane.
std::uint32_t find_shares(PreparedScene const& scene, SurfacePacket const& s, LaneMask lit, RankedLights const& ranked,
                          LaneVec3& shares) {
    std::uint32_t segments = 0;
    LaneVec3 sum;
    sum.fill(Vec3(0));
    std::array<int, lanes> rays{};
    RayPacket shadow;
    shadow.origin = s.leaving;
    shadow.near.fill(0);
    for (int ray = 0; ray < rays_to_others; ++ray) {
        LaneMask looking = 0;
        for_each_lane(lit, [&](int i) {
            RenderLight const& light = scene.lights[other_light(ranked, i, ray)];
            bool const is_sun = light.type == LightType::directional;
            Vec3 const towards = is_sun ? light.towards : light.position - s.position.get(i);
            if (glm::dot(towards, s.normal.get(i)) > 0) { // what lies behind the surface is not among what it gets
                shadow.direction.set(i, towards);
                shadow.far[i] = is_sun ? INFINITY : shadow_ray_share;
                looking |= 1u << i;
            }
        });
        if (looking == 0) {
            continue;
        }
        LaneVec3 passed;
        passed.fill(Vec3(1));
        LaneMask const blocked = scene.bvh.occluded(shadow, looking, passed);
        segments += static_cast<std::uint32_t>(std::popcount(looking));
        for_each_lane(looking, [&](int i) {
            ++rays[static_cast<std::size_t>(i)];
            sum.set(i, sum.get(i) + ((blocked >> i & 1) != 0 ? Vec3(0) : passed.get(i)));
        });
    }
    for (LaneMask left = lit; left != 0;) {
        LaneMask const together = lanes_beside_first(s, left);
        Vec3 all(0);
        int count = 0;
        for_each_lane(together, [&](int i) {
            all += sum.get(i);
            count += rays[static_cast<std::size_t>(i)];
        });
        Vec3 const share = count > 0 ? all / static_cast<float>(count) : Vec3(1);
        for_each_lane(together, [&](int i) { shares.set(i, share); });
        left &= ~together;
    }
    return segments;
}

std::uint32_t add_many_lights(PreparedScene const& scene, SurfacePacket const& s, LobePacket const& lobes, LaneMask lit,
                              bool is_plane, StrongestLight& strongest, LaneVec3& radiance) {
    thread_local RankedLights ranked;
    std::uint32_t segments = 0;
    LaneVec3 rest;
    rank_lights(scene, s, lobes, lit, ranked, rest);
    for (std::size_t i = 0; i < exact_lights; ++i) {
        std::uint32_t const number = ranked.order[i];
        if (ranked.weight[number] > 0) {
            take_away(scene.lights[number], s, lobes, lit, rest);
            add_shadowed(scene, number, s, lobes, lit, is_plane, strongest, radiance, segments);
        }
    }
    if (ranked.sums.back() <= 0) {
        return segments;
    }
    LaneVec3 shares;
    segments += find_shares(scene, s, lit, ranked, shares);
    for_each_lane(lit, [&](int i) { radiance.set(i, radiance.get(i) + shares.get(i) * rest.get(i)); });
    return segments;
}

} // namespace

std::uint32_t add_lights(PreparedScene const& scene, SurfacePacket const& s, LobePacket const& lobes, LaneMask lit,
                         bool is_plane, StrongestLight& strongest, LaneVec3& radiance) {
    if (scene.moves) {
        strongest.most.fill(0);
        std::ranges::fill(strongest.lost.lane, no_light);
    }
    if (lit == 0) {
        return 0;
    }
    if (scene.lights.size() > exact_lights + rays_to_others) {
        return add_many_lights(scene, s, lobes, lit, is_plane, strongest, radiance);
    }
    std::uint32_t segments = 0;
    for (std::uint32_t number = 0; number < scene.lights.size(); ++number) {
        add_shadowed(scene, number, s, lobes, lit, is_plane, strongest, radiance, segments);
    }
    return segments;
}

} // namespace framelet
