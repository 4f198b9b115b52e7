// The metallic-roughness BRDF of [glTF 2.0] appendix B: GGX distribution ([Walter 2007]), height-correlated Smith
// visibility, Fresnel term of [Schlick 1994], Lambertian diffuse. Written over sixteen lanes. What single reflection
// loses on rough surfaces comes back diffusely, of lamps as of the surroundings, as paths have it (`path/scattering`).
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

#include "server/render/light/split_sum.h"
#include "server/render/packet.h"

namespace framelet {

/// A surface as light meets it.
struct LobePacket {
    LaneVec3 diffuse; ///< albedo of the diffuse part
    LaneVec3 f0; ///< reflectance at normal incidence
    LaneVec3 specular; ///< the share of uniform light that the lobe reflects, set by `share_out`
    LaneFloats alpha2; ///< (perceptual roughness)^4
    LaneFloats normal_view; ///< cosine, > 0
};

/// Highlights of punctual lights are never sharper than this perceptual roughness: a point has no size of its own, and
/// without one a mirror would show it as a speck that no sampling rate resolves.
inline constexpr float sharpest_highlight = 0.1f;

/// Sets lobes from base colour, metallic and perceptual roughness.
inline void make_lobes(LaneVec3 const& base, LaneFloats const& metallic, LaneFloats const& roughness,
                       LaneVec3 const& normal, LaneVec3 const& view, LobePacket& out) {
    for (int i = 0; i < lanes; ++i) {
        float const m = metallic[i];
        out.diffuse.x[i] = base.x[i] * (1 - m);
        out.diffuse.y[i] = base.y[i] * (1 - m);
        out.diffuse.z[i] = base.z[i] * (1 - m);
        out.f0.x[i] = 0.04f + (base.x[i] - 0.04f) * m;
        out.f0.y[i] = 0.04f + (base.y[i] - 0.04f) * m;
        out.f0.z[i] = 0.04f + (base.z[i] - 0.04f) * m;
        float const r = roughness[i] > sharpest_highlight ? roughness[i] : sharpest_highlight;
        out.alpha2[i] = (r * r) * (r * r);
        float const cosine = normal.x[i] * view.x[i] + normal.y[i] * view.y[i] + normal.z[i] * view.z[i];
        out.normal_view[i] = cosine > 1e-3f ? cosine : 1e-3f;
    }
}

/// Lets the lobe take its share of what arrives, of these lanes: `diffuse` becomes what is reflected diffusely beside
/// it.
inline void share_out(SplitSumTable const& split_sum, LaneFloats const& roughness, LaneMask lit, LobePacket& lobes) {
    for_each_lane(lit, [&](int i) {
        AmbientShares const shares =
            ambient_shares(split_sum.at(lobes.normal_view[i], roughness[i]), lobes.f0.get(i), lobes.diffuse.get(i));
        lobes.diffuse.set(i, shares.diffuse);
        lobes.specular.set(i, shares.specular);
    });
}

/// Adds what the surface reflects towards `view` of light that arrives along `to_light` (unit) with the given
/// irradiance on the surface (cosine included). Lanes with irradiance 0 add nothing.
inline void add_reflected(LobePacket const& lobes, LaneVec3 const& normal, LaneVec3 const& view,
                          LaneVec3 const& to_light, LaneVec3 const& irradiance, LaneVec3& radiance) {
    constexpr float inverse_pi = std::numbers::inv_pi_v<float>;
    for (int i = 0; i < lanes; ++i) {
        float const lx = to_light.x[i], ly = to_light.y[i], lz = to_light.z[i];
        float hx = lx + view.x[i], hy = ly + view.y[i], hz = lz + view.z[i];
        float const scale = 1 / std::sqrt(hx * hx + hy * hy + hz * hz + 1e-20f);
        hx *= scale;
        hy *= scale;
        hz *= scale;
        float const nh = normal.x[i] * hx + normal.y[i] * hy + normal.z[i] * hz;
        float const vh = view.x[i] * hx + view.y[i] * hy + view.z[i] * hz;
        float const nl_signed = normal.x[i] * lx + normal.y[i] * ly + normal.z[i] * lz;
        float const nl = nl_signed > 1e-4f ? nl_signed : 1e-4f;
        float const nv = lobes.normal_view[i];
        float const a2 = lobes.alpha2[i];
        float const nh2 = nh * nh < 1 ? nh * nh : 1.0f;
        float const spread = (1 - nh2) + a2 * nh2;
        float const distribution = a2 * inverse_pi / (spread * spread);
        float const visibility =
            0.5f / (nl * std::sqrt(nv * nv * (1 - a2) + a2) + nv * std::sqrt(nl * nl * (1 - a2) + a2));
        float const specular = distribution * visibility;
        float const away = vh < 1 ? (vh > 0 ? 1 - vh : 1.0f) : 0.0f;
        float const fresnel = (away * away) * (away * away) * away;
        auto add = [&](float f0, float diffuse, float arriving, float& sum) {
            float const f = f0 + (1 - f0) * fresnel;
            sum += (diffuse * inverse_pi + f * specular) * arriving;
        };
        add(lobes.f0.x[i], lobes.diffuse.x[i], irradiance.x[i], radiance.x[i]);
        add(lobes.f0.y[i], lobes.diffuse.y[i], irradiance.y[i], radiance.y[i]);
        add(lobes.f0.z[i], lobes.diffuse.z[i], irradiance.z[i], radiance.z[i]);
    }
}

} // namespace framelet
