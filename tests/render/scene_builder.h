// Small scenes made in code, and single rays through them, for the tests of this layer.
#pragma once

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>

#include "server/render/framelet_renderer.h"
#include "server/render/prepared/prepared_scene.h"
#include "server/render/trace/tracing.h"

namespace framelet::test {

/// Parallelogram with corner, two sides and the normal side_u x side_v; uv (0,0) at the corner, v along side_v.
inline Primitive quad(Vec3 corner, Vec3 side_u, Vec3 side_v, Index material) {
    Primitive p;
    p.positions = {corner, corner + side_u, corner + side_u + side_v, corner + side_v};
    p.normals.assign(4, glm::normalize(glm::cross(side_u, side_v)));
    p.uv[0] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    p.triangles = {{0, 1, 2}, {0, 2, 3}};
    p.material = material;
    return p;
}

inline Primitive sphere(Vec3 center, float radius, Index material, int rings = 48) {
    Primitive p;
    p.material = material;
    auto index = [&](int i, int j) { return static_cast<std::uint32_t>(i * (2 * rings + 1) + j); };
    for (int i = 0; i <= rings; ++i) {
        for (int j = 0; j <= 2 * rings; ++j) {
            float const theta = std::numbers::pi_v<float> * static_cast<float>(i) / static_cast<float>(rings);
            float const phi = std::numbers::pi_v<float> * static_cast<float>(j) / static_cast<float>(rings);
            Vec3 const n(std::sin(theta) * std::sin(phi), std::cos(theta), std::sin(theta) * std::cos(phi));
            p.positions.push_back(center + radius * n);
            p.normals.push_back(n);
            if (i < rings && j < 2 * rings) {
                p.triangles.push_back({index(i, j), index(i + 1, j), index(i + 1, j + 1)});
                p.triangles.push_back({index(i, j), index(i + 1, j + 1), index(i, j + 1)});
            }
        }
    }
    return p;
}

inline Material matte(Vec3 color) {
    Material m;
    m.base_color = Vec4(color, 1);
    m.metallic = 0;
    m.roughness = 1;
    return m;
}

/// Adds a mesh of one primitive and a node that draws it; returns the node.
inline Index add(Scene& scene, Primitive primitive, Transform transform = {}) {
    Mesh mesh;
    mesh.primitives.push_back(std::move(primitive));
    mesh.morph_weights.assign(mesh.primitives[0].morph_targets.size(), 0.0f);
    scene.meshes.push_back(std::move(mesh));
    Node node;
    node.mesh = static_cast<Index>(scene.meshes.size() - 1);
    node.local = transform;
    scene.nodes.push_back(node);
    return static_cast<Index>(scene.nodes.size() - 1);
}

/// Adds a light on a node of its own that shines along `direction` from `position`.
inline void add_light(Scene& scene, Light light, Vec3 position, Vec3 direction) {
    Node node;
    node.local.translation = position;
    node.local.rotation = look_at(position, position + direction, {0, 1, 0}, 1).orientation;
    scene.nodes.push_back(node);
    light.node = static_cast<Index>(scene.nodes.size() - 1);
    scene.lights.push_back(light);
}

/// Adds a texture of the given size whose texels `color(x, y)` tells, bytes as stored.
inline Index add_texture(Scene& scene, int width, int height,
                         std::function<std::array<std::uint8_t, 4>(int, int)> const& color, Wrap wrap = Wrap::repeat) {
    auto picture = std::make_shared<Picture>(width, height);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            std::array<std::uint8_t, 4> const texel = color(x, y);
            std::copy(texel.begin(), texel.end(), picture->row(y) + static_cast<std::ptrdiff_t>(x) * 4);
        }
    }
    scene.images.push_back(picture);
    Texture texture;
    texture.image = static_cast<Index>(scene.images.size() - 1);
    texture.wrap_u = texture.wrap_v = wrap;
    scene.textures.push_back(texture);
    return static_cast<Index>(scene.textures.size() - 1);
}

struct Seen {
    Vec3 radiance;
    float depth;
};

/// Radiance and depth that one ray sees; `direction` need not be a unit vector, depth counts in its lengths.
inline Seen look_along(RenderScene const& scene, Vec3 origin, Vec3 direction) {
    RayPacket rays{};
    rays.origin.fill(origin);
    rays.direction.fill(direction);
    rays.far.fill(INFINITY);
    Footprint footprint{};
    TracedPacket out{};
    trace(scene.prepared(), rays, 1, footprint, 1, out);
    return {out.radiance.get(0), out.depth[0]};
}

inline Environment black() {
    return Environment::uniform(Vec3(0));
}

} // namespace framelet::test
