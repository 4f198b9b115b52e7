// Finds where the scene is and how to look at it.
#include <algorithm>

#include "server/scene/motion/animation.h"
#include "server/scene/vector_math.h"

namespace framelet {

namespace {

bool takes_light(Material const& material) {
    return !material.unlit && Vec3(material.base_color) != Vec3(0);
}

} // namespace

Camera scene_camera(Scene const& scene, ScenePose const& pose, Index index) {
    SceneCamera const& from = scene.cameras[static_cast<std::size_t>(index)];
    Mat4 const& world = pose.world_from_node[static_cast<std::size_t>(from.node)];
    Vec3 const back = unit_or(Vec3(world[2]), Vec3(0, 0, 1));
    Vec3 const up_hint = unit_or(Vec3(world[1]), Vec3(0, 1, 0));
    Vec3 const up = unit_or(up_hint - back * glm::dot(up_hint, back), any_perpendicular(back));
    Camera camera;
    camera.position = Vec3(world[3]);
    camera.orientation = glm::normalize(glm::quat_cast(Mat3(glm::cross(up, back), up, back)));
    camera.projection = from.projection;
    camera.vertical_extent = from.vertical_extent;
    return within_bounds(camera); // an animation may lead anywhere
}

std::vector<ScenePart> scene_parts(Scene const& scene, ScenePose const& pose) {
    std::vector<ScenePart> out;
    DeformedVertices deformed;
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node const& node = scene.nodes[i];
        if (node.mesh == none) {
            continue;
        }
        Skin const* const skin = node.skin == none ? nullptr : &scene.skins[static_cast<std::size_t>(node.skin)];
        for (Primitive const& primitive : scene.meshes[static_cast<std::size_t>(node.mesh)].primitives) {
            bool const rigid = !skin && primitive.morph_targets.empty();
            if (!rigid) {
                deform(primitive, pose.morph_weights[i], skin, pose, deformed);
            }
            Mat4 const world = skin ? Mat4(1) : pose.world_from_node[i];
            Bounds box;
            for (Vec3 const& position : rigid ? primitive.positions : deformed.positions) {
                box.include(Vec3(world * Vec4(position, 1)));
            }
            if (!box.empty()) {
                auto const material = static_cast<std::size_t>(primitive.material);
                out.push_back({box, material >= scene.materials.size() || takes_light(scene.materials[material])});
            }
        }
    }
    return out;
}

Bounds scene_bounds(Scene const& scene, ScenePose const& pose) {
    Bounds bounds;
    for (ScenePart const& part : scene_parts(scene, pose)) {
        bounds.include(part.box.lower);
        bounds.include(part.box.upper);
    }
    return bounds;
}

Camera default_camera(Bounds const& bounds) {
    constexpr float vertical_fov = 0.7f;
    constexpr float aspect = 16.0f / 9.0f;
    constexpr float margin = 1.05f;
    Bounds box = bounds;
    if (box.empty()) {
        box.include(Vec3(-0.5f));
        box.include(Vec3(0.5f));
    }
    Vec3 const center = box.center();
    // Models face +Z (glTF 2.0 section 3.4): stand in front, to the right of the model's left, a little above.
    Vec3 const direction = glm::normalize(Vec3(0.6f, 0.4f, 1.0f));
    Camera const turned = look_at(center + direction, center, Vec3(0, 1, 0), vertical_fov);
    float const tan_y = std::tan(0.5f * vertical_fov) / margin;
    float const tan_x = tan_y * aspect;
    // A corner is in view where |right| <= tan_x * depth and |up| <= tan_y * depth; depth grows with the distance.
    float distance = 0;
    for (int corner = 0; corner < 8; ++corner) {
        Vec3 const offset = 0.5f * box.size() * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        float const depth = glm::dot(offset, turned.forward());
        distance = std::max({distance, std::abs(glm::dot(offset, turned.right())) / tan_x - depth,
                             std::abs(glm::dot(offset, turned.up())) / tan_y - depth});
    }
    Vec3 const size = box.size();
    bool const is_point = size.x + size.y + size.z == 0;
    float const least = std::max(is_point ? 1e-3f : 0.0f, 1e-4f * glm::length(center)); // what is far is less exact
    return within_bounds(look_at(center + direction * std::max(distance, least), center, Vec3(0, 1, 0), vertical_fov));
}

} // namespace framelet
