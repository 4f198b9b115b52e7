#include "server/render/trace/surrounding_light.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "server/render/cache/light_cache.h"
#include "server/render/light/luminance.h"
#include "server/render/prepared/light_frame.h"

namespace framelet {
namespace {

/// Size of the cells that are looked up, in pixels of the picture.
constexpr float cell_pixels = 12;
/// Lanes whose normals differ by less, and that lie no farther off one plane than this share of their distance, are
/// looked up together.
constexpr float same_cosine = 0.98f;
constexpr float same_plane = 0.02f;

/// The corners of a packet of 4x4 neighbours in Morton order, and what they weigh in each lane.
constexpr int corners = 4;
constexpr std::array<int, corners> corner_lane{0, 5, 10, 15};
constexpr std::array<std::array<float, lanes>, corners> corner_weights() {
    std::array<std::array<float, lanes>, corners> out{};
    for (int lane = 0; lane < lanes; ++lane) {
        float const x = static_cast<float>((lane & 1) | (lane >> 1 & 2)) / 3;
        float const y = static_cast<float>((lane >> 1 & 1) | (lane >> 2 & 2)) / 3;
        auto const i = static_cast<std::size_t>(lane);
        out[0][i] = (1 - x) * (1 - y);
        out[1][i] = x * (1 - y);
        out[2][i] = (1 - x) * y;
        out[3][i] = x * y;
    }
    return out;
}
constexpr auto weights = corner_weights();

/// Where most of what a rough surface reflects comes from: the rougher it is, the nearer its normal, since nothing
/// comes from below it ([Lagarde 2014]).
Vec3 lobe_middle(SurfacePacket const& s, int i) {
    float const smooth = std::clamp(1 - s.roughness[i], 0.0f, 1.0f);
    return glm::normalize(glm::mix(s.normal.get(i), mirrored(s, i), smooth * (std::sqrt(smooth) + s.roughness[i])));
}

void add_environment(PreparedScene const& scene, SurfacePacket const& s, LaneMask lit, SurroundingLight& out) {
    for_each_lane(lit, [&](int i) {
        out.diffuse.set(i, scene.environment.diffuse(s.normal.get(i)) * s.occlusion[i]);
        out.specular.set(i, scene.environment.specular(lobe_middle(s, i), s.roughness[i]) * s.occlusion[i]);
    });
}

/// Those of `lanes_left`, all of a block, that lie on one plane with the first of them: of one instance, or of what
/// stands still.
LaneMask lanes_on_plane(PreparedScene const& scene, HitPacket const& hits, SurfacePacket const& s,
                        LaneMask lanes_left) {
    int const first = std::countr_zero(lanes_left);
    Vec3 const origin = s.position.get(first), normal = s.geometric_normal.get(first);
    Instance const& instance = scene.instances[hits.instance[first]];
    bool const moves = instance.moves();
    LaneMask out = lanes_left & -lanes_left; // itself, were its normal none
    for_each_lane(lanes_left, [&](int i) {
        Instance const& other = scene.instances[hits.instance[i]];
        Vec3 const away = s.position.get(i) - origin;
        if ((moves ? &other == &instance : !other.moves()) &&
            glm::dot(s.geometric_normal.get(i), normal) > same_cosine &&
            std::abs(glm::dot(away, normal)) <= same_plane * glm::length(away)) {
            out |= 1u << i;
        }
    });
    return out;
}

/// Turns what arrives at a lane's facet into what its shading normal and its lobe get of it.
void set_lane(PreparedScene const& scene, SurfacePacket const& s, int i, IncomingLight const& in,
              SurroundingLight& out) {
    Vec3 const facet = s.geometric_normal.get(i), normal = s.normal.get(i);
    Vec3 const lean = in.lean - facet * glm::dot(in.lean, facet);
    // Were radiance linear in the direction, a + b.w, `lean` would be b / 4, and irradiance / pi about a bent normal
    // n would be a + (2 / 3) b.n.
    constexpr float bend = 8.0f / 3, most_bent = 2;
    float const shade = luminance(in.all);
    float const factor = shade > 0 ? std::clamp(1 + bend * glm::dot(lean, normal) / shade, 0.0f, most_bent) : 1.0f;
    out.diffuse.set(i, in.all * factor);
    float const share = scene.environment.light_share();
    Vec3 const sky = share > 0 && in.open > 0
                         ? scene.environment.specular(lobe_middle(s, i), s.roughness[i]) * (in.open / share)
                         : Vec3(0);
    out.specular.set(i, in.reflected + sky);
}

/// The lane in the middle of some, which are not none: in Morton order, so that it is not at their edge.
int middle_lane(LaneMask some) {
    for (int before = std::popcount(some) / 2; before > 0; --before) {
        some &= some - 1;
    }
    return std::countr_zero(some);
}

IncomingLight look_up(PreparedScene const& scene, HitPacket const& hits, SurfacePacket const& s, int i,
                      LaneFloats const& pixels, bool& known) {
    LightPlace const place = light_place(scene, hits.instance[i], s.leaving.get(i), s.geometric_normal.get(i));
    IncomingLight in;
    known = scene.light_cache->look_up(place, s.width[i] * (cell_pixels / pixels[i]), in);
    if (known && place.frame != 0) {
        in.lean = light_frame(scene, place.frame).rotation * in.lean;
    }
    return in;
}

/// Looks up the corners of a packet and sets all its lanes by them. False where a corner is not known.
bool look_up_corners(PreparedScene const& scene, HitPacket const& hits, SurfacePacket const& s,
                     LaneFloats const& pixels, SurroundingLight& out) {
    std::array<IncomingLight, corners> at;
    bool all_known = true;
    for (std::size_t c = 0; c < corners; ++c) {
        bool known = false;
        at[c] = look_up(scene, hits, s, corner_lane[c], pixels, known);
        all_known = all_known && known;
    }
    for (int i = 0; all_known && i < lanes; ++i) {
        IncomingLight in;
        for (std::size_t c = 0; c < corners; ++c) {
            in.add(at[c], weights[c][static_cast<std::size_t>(i)]);
        }
        set_lane(scene, s, i, in, out);
    }
    return all_known;
}

} // namespace

Vec3 mirrored(SurfacePacket const& s, int i) {
    Vec3 const n = s.normal.get(i);
    Vec3 const v = s.view.get(i);
    return n * (2 * glm::dot(n, v)) - v;
}

void find_surrounding_light(PreparedScene const& scene, HitPacket const& hits, SurfacePacket const& s, LaneMask lit,
                            Footprint const& footprint, SurroundingLight& out) {
    LaneMask unknown = lit;
    if (scene.light_cache != nullptr) {
        for (LaneMask left = lit; left != 0;) {
            LaneMask const together = footprint.is_block ? lanes_on_plane(scene, hits, s, left) : left & -left;
            out.is_plane = together == all_lanes;
            if (out.is_plane && look_up_corners(scene, hits, s, footprint.pixels, out)) {
                return;
            }
            bool known = false;
            IncomingLight const in = look_up(scene, hits, s, middle_lane(together), footprint.pixels, known);
            if (known) {
                for_each_lane(together, [&](int i) { set_lane(scene, s, i, in, out); });
                unknown &= ~together;
            }
            left &= ~together;
        }
    }
    add_environment(scene, s, unknown, out);
}

} // namespace framelet
