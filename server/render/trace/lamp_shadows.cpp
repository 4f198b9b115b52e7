#include "server/render/trace/lamp_shadows.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include "server/render/light/sphere_sampling.h"

namespace framelet {
namespace {

/// Rays a lane where a light is partly hidden.
constexpr int rays_in_penumbra = 4;
/// Where the rays of each lane differ among themselves as much as all rays do, times this share, a penumbra is wider
/// than lanes lie apart. In a narrow one they agree, and lanes differ.
constexpr float wide_share = 0.5f;

/// Sixteen points of a disc of radius 1, four in each quadrant, of equal shares, at different distances from lines.
std::array<Vec2, 16> const& disc_points() {
    static std::array<Vec2, 16> const points = [] {
        std::array<Vec2, 16> out;
        for (int i = 0; i < 16; ++i) {
            constexpr std::array<float, 4> quarter{0.125f, 0.625f, 0.375f, 0.875f}; // of a quadrant's right angle
            auto const part = static_cast<std::size_t>(i & 3);
            float const turn = 0.5f * std::numbers::pi_v<float> * (static_cast<float>(i >> 2) + quarter[part]);
            float const radius = std::sqrt((static_cast<float>(part) + 0.5f) / 4);
            out[static_cast<std::size_t>(i)] = radius * Vec2(std::cos(turn), std::sin(turn));
        }
        return out;
    }();
    return points;
}

/// The point of the light to which a lane's ray goes: neighbours look at other quadrants, and so do a lane's own rays.
/// All lanes together look at all points.
Vec2 point_of(int lane, int ray) {
    int const quadrant = (lane + ray) & 3, part = ((lane >> 2) + ray) & 3;
    return disc_points()[static_cast<std::size_t>(4 * quadrant + part)];
}

/// Aims rays at the points of a light with a size.
void aim(RenderLight const& light, LampSizes sizes, ArrivingLight const& arriving, LaneMask active, int ray,
         RayPacket& shadow) {
    bool const is_sun = light.type == LightType::directional;
    for_each_lane(active, [&](int i) {
        Vec3 const towards = arriving.to_light.get(i);
        Vec2 const aside = (is_sun ? std::tan(sizes.sun) : sizes.lamp) * point_of(i, ray);
        Mat3 const frame = frame_about(towards);
        float distance = 1;
        if (!is_sun) { // to the side of the sphere that is seen
            float const before = std::sqrt(sizes.lamp * sizes.lamp - glm::dot(aside, aside));
            distance = std::max(arriving.distance[i] - before, 0.5f * arriving.distance[i]);
        }
        shadow.direction.set(i, towards * distance + frame[0] * aside.x + frame[1] * aside.y);
        shadow.far[i] = is_sun ? INFINITY : shadow_ray_share;
    });
}

/// Sums over the rays of each lane: the shares that got through, and their squares (of green).
struct Shares {
    LaneVec3 sum;
    LaneFloats squares;

    void add(LaneMask reached, LaneVec3 const& passed) {
        for_each_lane(reached, [&](int i) {
            Vec3 const share = passed.get(i);
            sum.set(i, sum.get(i) + share);
            squares[i] += share.g * share.g;
        });
    }
};

/// Replaces the shares of 4x4 neighbours by the plane that fits them best.
void smooth(LaneFloats& share) {
    float sum = 0, across = 0, down = 0;
    auto const place = [](int lane) {
        return Vec2((lane & 1) | (lane >> 1 & 2), (lane >> 1 & 1) | (lane >> 2 & 2)) - 1.5f;
    };
    for (int i = 0; i < lanes; ++i) {
        Vec2 const at = place(i);
        sum += share[i];
        across += at.x * share[i];
        down += at.y * share[i];
    }
    constexpr float squares = 20; // sum of at.x * at.x over all lanes
    for (int i = 0; i < lanes; ++i) {
        Vec2 const at = place(i);
        share[i] = std::clamp(sum / lanes + (at.x * across + at.y * down) / squares, 0.0f, 1.0f);
    }
}

/// True where what gets through changes but a little from lane to lane.
bool is_wide(Shares const& shares) {
    constexpr float rays = rays_in_penumbra, few = rays / (rays - 1); // a variance of few
    float mean = 0, squares = 0, within = 0;
    for (int i = 0; i < lanes; ++i) {
        float const own = shares.sum.y[i] / rays, own_squares = shares.squares[i] / rays;
        mean += own / lanes;
        squares += own_squares / lanes;
        within += few / lanes * (own_squares - own * own);
    }
    return within >= wide_share * (squares - mean * mean);
}

/// Follows rays to a light; what something opaque blocks passes nothing.
void follow(PreparedScene const& scene, RayPacket const& shadow, LaneMask reached, LaneVec3& passed) {
    passed.fill(Vec3(1));
    for_each_lane(scene.bvh.occluded(shadow, reached, passed), [&](int i) { passed.set(i, Vec3(0)); });
}

bool is_alike(LaneMask reached, LaneVec3 const& passed) {
    Vec3 const first = passed.get(std::countr_zero(reached));
    bool alike = true;
    for_each_lane(reached, [&](int i) { alike = alike && passed.get(i) == first; });
    return alike;
}

LaneMask dark_lanes(LaneMask reached, LaneVec3 const& passed) {
    return reached & lanes_where([&](int i) { return passed.get(i) == Vec3(0); });
}

} // namespace

LaneMask find_shadow(PreparedScene const& scene, RenderLight const& light, SurfacePacket const& s,
                     ArrivingLight const& arriving, LaneMask reached, bool is_plane, LaneVec3& passed,
                     std::uint32_t& segments) {
    RayPacket shadow;
    shadow.origin = s.leaving;
    shadow.near.fill(0);
    shadow.direction = arriving.to_light;
    for (int i = 0; i < lanes; ++i) {
        shadow.far[i] = arriving.distance[i] * shadow_ray_share;
    }
    float const size = light.type == LightType::directional ? scene.lamp_sizes.sun : scene.lamp_sizes.lamp;
    if (size > 0) {
        aim(light, scene.lamp_sizes, arriving, reached, 0, shadow);
    }
    segments += static_cast<std::uint32_t>(std::popcount(reached));
    follow(scene, shadow, reached, passed);
    if (size <= 0 || is_alike(reached, passed)) {
        return dark_lanes(reached, passed);
    }
    Shares shares{};
    shares.add(reached, passed);
    for (int ray = 1; ray < rays_in_penumbra; ++ray) {
        aim(light, scene.lamp_sizes, arriving, reached, ray, shadow);
        follow(scene, shadow, reached, passed);
        shares.add(reached, passed);
    }
    segments += static_cast<std::uint32_t>((rays_in_penumbra - 1) * std::popcount(reached));
    for (int i = 0; i < lanes; ++i) {
        passed.set(i, shares.sum.get(i) / static_cast<float>(rays_in_penumbra));
    }
    if (is_plane && reached == all_lanes && is_wide(shares)) {
        smooth(passed.x);
        smooth(passed.y);
        smooth(passed.z);
    }
    return dark_lanes(reached, passed);
}

} // namespace framelet
