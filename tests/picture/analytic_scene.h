// Scenes of textured parallelograms before a sky, cast ray by ray: exact framelets with exact shapes from any camera at
// any time, and what a picture from another one must show.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "common/framelet/body_motion.h"
#include "common/held/framelet_cache.h"

namespace framelet {

/// Colour of a point: sRGB-encoded values in [0, 255] before rounding.
using Color = std::array<float, 3>;

struct Quad {
    glm::dvec3 corner{0}, u{1, 0, 0}, v{0, 1, 0}; ///< at time 0
    std::function<Color(double u, double v)> texture; ///< on [0, 1]^2
    BodyNumber body = static_body;
    glm::dvec3 velocity{0};
};

struct Hit {
    int quad = -1; ///< -1: the sky
    double inverse_depth = 0;
    Color color{};
};

struct AnalyticScene {
    std::vector<Quad> quads;
    std::function<Color(glm::dvec3 direction)> sky = [](glm::dvec3) { return Color{90, 120, 200}; };
    BodyMotions motions;

    Quad at_time(Quad quad, SceneTime time) const {
        Motion const motion = motions.between(quad.body, 0, time);
        quad.corner = motion.linear * quad.corner + motion.offset + time * quad.velocity;
        quad.u = motion.linear * quad.u;
        quad.v = motion.linear * quad.v;
        return quad;
    }

    std::vector<Quad> at_time(SceneTime time) const {
        std::vector<Quad> out;
        for (Quad const& quad : quads) {
            out.push_back(at_time(quad, time));
        }
        return out;
    }

    /// Inverse depth at a pixel of the plane that a quad lies in.
    static double plane_inverse_depth(Quad const& quad, ViewRays const& rays, double x, double y) {
        glm::dvec3 const normal = glm::cross(quad.u, quad.v);
        return glm::dot(normal, direction(rays, x, y)) / glm::dot(normal, quad.corner - glm::dvec3(rays.origin));
    }

    static glm::dvec3 direction(ViewRays const& rays, double x, double y) {
        return glm::dvec3(rays.direction) + x * glm::dvec3(rays.direction_dx) + y * glm::dvec3(rays.direction_dy);
    }

    Hit cast(std::vector<Quad> const& placed, ViewRays const& rays, double x, double y) const {
        Hit hit;
        glm::dvec3 const towards = direction(rays, x, y);
        for (std::size_t i = 0; i < placed.size(); ++i) {
            Quad const& quad = placed[i];
            double const w = plane_inverse_depth(quad, rays, x, y);
            if (!(w > hit.inverse_depth)) {
                continue;
            }
            glm::dvec3 const from = glm::dvec3(rays.origin) + towards / w - quad.corner;
            double const uu = glm::dot(quad.u, quad.u), uv = glm::dot(quad.u, quad.v), vv = glm::dot(quad.v, quad.v);
            double const pu = glm::dot(from, quad.u), pv = glm::dot(from, quad.v);
            double const det = uu * vv - uv * uv;
            double const u = (vv * pu - uv * pv) / det;
            double const v = (uu * pv - uv * pu) / det;
            if (u >= 0 && u <= 1 && v >= 0 && v <= 1) {
                hit = {static_cast<int>(i), w, quad.texture(u, v)};
            }
        }
        if (hit.quad < 0) {
            hit.color = sky(glm::normalize(towards));
        }
        return hit;
    }

    /// Adds a framelet to the batch, from the batch's camera at its time. `all_outliers`: no layers.
    void render(ImagePlane const& plane, Tile tile, Batch& batch, bool all_outliers = false) const {
        std::vector<Quad> const placed = at_time(batch.scene_time);
        ViewRays const rays = make_view_rays(batch.view.camera, plane.viewport());
        PixelRect const rect = plane.tile_rect(tile);
        double const spacing = static_cast<double>(plane.sample_spacing(tile));
        DisplayFramelet framelet;
        framelet.tile = tile;
        FrameletShape shape;
        std::array<int, max_layers> quad_of_layer{};
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            Hit const hit =
                cast(placed, rays, rect.left + (morton_x(i) + 0.5) * spacing, rect.top + (morton_y(i) + 0.5) * spacing);
            auto const byte = [](float value) { return static_cast<std::uint8_t>(value + 0.5f); };
            framelet.red[i] = byte(hit.color[0]);
            framelet.green[i] = byte(hit.color[1]);
            framelet.blue[i] = byte(hit.color[2]);
            std::uint8_t layer = 0;
            while (layer < shape.layer_count && quad_of_layer[layer] != hit.quad) {
                ++layer;
            }
            if (layer == max_layers || all_outliers) {
                shape.layer_of[i] = FrameletShape::outlier;
                Outlier outlier{static_cast<float>(hit.inverse_depth), static_body, {}};
                if (hit.quad >= 0) {
                    outlier.body = placed[static_cast<std::size_t>(hit.quad)].body;
                    outlier.drift.velocity = Vec3(placed[static_cast<std::size_t>(hit.quad)].velocity);
                }
                shape.outliers.push_back(outlier);
                continue;
            }
            if (layer == shape.layer_count) {
                quad_of_layer[layer] = hit.quad;
                ++shape.layer_count;
                if (hit.quad >= 0) {
                    Quad const& quad = placed[static_cast<std::size_t>(hit.quad)];
                    double const at = plane_inverse_depth(quad, rays, rect.left, rect.top);
                    shape.layers[layer] = {
                        static_cast<float>(at),
                        static_cast<float>(plane_inverse_depth(quad, rays, rect.left + 1, rect.top) - at),
                        static_cast<float>(plane_inverse_depth(quad, rays, rect.left, rect.top + 1) - at),
                        0,
                        quad.body,
                        {{Vec3(quad.velocity)}}};
                }
            }
            shape.layer_of[i] = layer;
        }
        batch.framelets.push_back(framelet);
        batch.shapes.push_back(shape);
    }

    Batch batch(ImagePlane const& plane, std::uint64_t number, Camera const& camera, SceneTime time,
                std::vector<Tile> const& tiles, bool all_outliers = false) const {
        Batch out;
        out.number = number;
        out.view = {number, camera, plane.viewport()};
        out.scene_time = time;
        for (Tile const tile : tiles) {
            render(plane, tile, out, all_outliers);
        }
        return out;
    }

    /// The hit of a ray through a display pixel at the display time, and whether the source saw the same point then.
    struct Expected {
        Hit hit;
        bool was_seen = false; ///< the source saw it, and all around it by `margin` pixels the same quad
    };

    Expected expect(Camera const& source, SceneTime source_time, Camera const& display, SceneTime display_time,
                    Viewport viewport, double x, double y, double margin) const {
        ViewRays const to = make_view_rays(display, viewport);
        ViewRays const from = make_view_rays(source, viewport);
        std::vector<Quad> const after = at_time(display_time);
        std::vector<Quad> const before = at_time(source_time);
        Expected out;
        out.hit = cast(after, to, x, y);
        glm::dvec3 towards = direction(to, x, y); // direction of the point, then from the source's origin
        if (out.hit.quad >= 0) {
            auto const i = static_cast<std::size_t>(out.hit.quad);
            glm::dmat3 const axes(after[i].u, after[i].v, glm::cross(after[i].u, after[i].v));
            glm::dmat3 const old_axes(before[i].u, before[i].v, glm::cross(before[i].u, before[i].v));
            glm::dvec3 const point = glm::dvec3(to.origin) + towards / out.hit.inverse_depth;
            towards = before[i].corner + old_axes * (glm::inverse(axes) * (point - after[i].corner)) -
                      glm::dvec3(from.origin);
        }
        glm::dmat3 const basis(glm::dvec3(from.direction_dx), glm::dvec3(from.direction_dy),
                               glm::dvec3(from.direction));
        glm::dvec3 const pixel = glm::inverse(basis) * towards;
        if (!(pixel.z > 0)) {
            return out;
        }
        out.was_seen = true;
        for (double const dy : {-margin, 0.0, margin}) {
            for (double const dx : {-margin, 0.0, margin}) {
                double const px = pixel.x / pixel.z + dx;
                double const py = pixel.y / pixel.z + dy;
                out.was_seen = out.was_seen && px > 0 && py > 0 && px < viewport.width && py < viewport.height &&
                               cast(before, from, px, py).quad == out.hit.quad;
            }
        }
        return out;
    }
};

inline std::function<Color(double, double)> plain(float red, float green, float blue) {
    return [=](double, double) { return Color{red, green, blue}; };
}

/// Waves whose squares are sines: red along u, green along v.
inline std::function<Color(double, double)> waves(double across, double down) {
    return [=](double u, double v) {
        auto const wave = [](double phase) {
            return static_cast<float>(255 * std::sqrt(0.5 + 0.4 * std::sin(2 * 3.14159265358979 * phase)));
        };
        return Color{wave(across * u), wave(down * v), 100};
    };
}

} // namespace framelet
