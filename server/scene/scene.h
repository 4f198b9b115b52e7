// A scene as plain values, the way glTF 2.0 describes one; every importer produces this, the renderer reads it.
// Units: metres, seconds, radians; right-handed, +Y up; texture coordinates with (0,0) at the image's upper left.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/camera.h"
#include "common/image.h"
#include "common/math.h"

namespace framelet {

/// Index into one of the scene's vectors; `none` where there is nothing.
using Index = int;
inline constexpr Index none = -1;

enum class Wrap : std::uint8_t { repeat, clamp, mirror };

/// One image with a way to sample it. Several textures may share an image.
struct Texture {
    Index image = none;
    Wrap wrap_u = Wrap::repeat;
    Wrap wrap_v = Wrap::repeat;
    bool nearest = false; ///< magnification without interpolation
};

/// A use of a texture by a material.
struct TextureUse {
    Index texture = none;
    int uv_set = 0; ///< 0 or 1
    Vec2 offset{0, 0}; ///< KHR_texture_transform, see `transform_uv`
    Vec2 scale{1, 1};
    float rotation = 0; ///< radians, counter-clockwise in the picture
};

/// KHR_texture_transform: uv' = offset + rotation * (scale * uv), as the extension's matrices say.
inline Vec2 transform_uv(TextureUse const& use, Vec2 const& uv) {
    Vec2 const s = uv * use.scale;
    float const sine = std::sin(use.rotation);
    float const cosine = std::cos(use.rotation);
    return use.offset + Vec2(cosine * s.x + sine * s.y, cosine * s.y - sine * s.x);
}

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

/// glTF metallic-roughness material. Colour factors are linear.
struct Material {
    std::string name;
    Vec4 base_color{1, 1, 1, 1};
    float metallic = 1;
    float roughness = 1;
    Vec3 emissive{0, 0, 0}; ///< includes KHR_materials_emissive_strength
    float normal_scale = 1;
    float occlusion_strength = 1;
    float transmission = 0; ///< KHR_materials_transmission, 0..1: rendered as straight-through rays
    AlphaMode alpha_mode = AlphaMode::opaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    bool unlit = false;
    TextureUse base_color_texture; ///< sRGB + alpha
    TextureUse metallic_roughness_texture; ///< roughness in G, metallic in B
    TextureUse normal_texture;
    TextureUse occlusion_texture; ///< R
    TextureUse emissive_texture; ///< sRGB
    TextureUse transmission_texture; ///< R
};

/// Points at each use of a texture by the material.
template <class AnyMaterial>
auto texture_uses(AnyMaterial& m) {
    return std::array{&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                      &m.occlusion_texture,  &m.emissive_texture,           &m.transmission_texture};
}

/// Offsets added to a primitive's attributes, each times the target's weight. Empty where absent.
struct MorphTarget {
    std::vector<Vec3> positions, normals, tangents;
};

/// Up to four joints of a vertex, the strongest first; weights sum to 1. `joints` index the skin's joint list.
struct JointInfluence {
    std::array<std::uint16_t, 4> joints{};
    std::array<float, 4> weights{};
};

/// A triangle list of one material, in the space of the node that has its mesh. Vertex attributes have one entry a
/// vertex or are empty; normals are never empty after import (where a file has none, vertices are split to make flat
/// ones).
struct Primitive {
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    std::vector<Vec4> tangents; ///< xyz unit tangent, w = +-1 handedness; present where the material has a normal map
    std::array<std::vector<Vec2>, 2> uv;
    std::vector<Vec4> colors; ///< linear, multiplies the base colour
    std::vector<JointInfluence> influences;
    std::vector<MorphTarget> morph_targets;
    std::vector<std::array<std::uint32_t, 3>> triangles;
    Index material = 0;
};

struct Mesh {
    std::string name;
    std::vector<Primitive> primitives;
    std::vector<float> morph_weights; ///< defaults, one a morph target
};

inline std::size_t count_triangles(Mesh const& mesh) {
    std::size_t count = 0;
    for (Primitive const& primitive : mesh.primitives) {
        count += primitive.triangles.size();
    }
    return count;
}

/// Translation, rotation and scale, applied as T * R * S. Translations have more digits than a float: files keep
/// coordinates of maps, of which only differences show.
struct Transform {
    glm::dvec3 translation{0, 0, 0};
    Quat rotation{1, 0, 0, 0};
    Vec3 scale{1, 1, 1};
};

struct Node {
    std::string name;
    Index parent = none; ///< always smaller than the node's own index
    Transform local; ///< in the parent's space; used unless `matrix` is set
    std::optional<glm::dmat4> matrix; ///< a local matrix as the file gives it; never animated
    Index mesh = none;
    Index skin = none;
    std::vector<float> morph_weights; ///< overrides the mesh's where not empty
};

struct Skin {
    std::vector<Index> joints; ///< nodes
    std::vector<Mat4> inverse_bind_matrices; ///< one a joint: from the mesh's space into the joint's
};

enum class Interpolation : std::uint8_t { step, linear, cubic_spline };
enum class AnimatedProperty : std::uint8_t { translation, rotation, scale, morph_weights };

/// Keyframes of one property of one node. `values` has `components` floats a key (3, 4 as xyzw, or the number of morph
/// targets); three times as many for cubic splines: in-tangent, value, out-tangent.
struct AnimationChannel {
    Index node = none;
    AnimatedProperty property = AnimatedProperty::translation;
    Interpolation interpolation = Interpolation::linear;
    int components = 3;
    std::vector<float> times; ///< seconds, strictly increasing
    std::vector<float> values;
};

struct AnimationClip {
    std::string name;
    float duration = 0; ///< seconds; the clip loops
    std::vector<AnimationChannel> channels;
};

enum class LightType : std::uint8_t { directional, point, spot };

/// A light as in KHR_lights_punctual; it shines along its node's -Z.
struct Light {
    std::string name;
    LightType type = LightType::point;
    Index node = none;
    Vec3 color{1, 1, 1}; ///< linear
    float intensity = 1; ///< candela for point and spot, lux for directional
    float range = 0; ///< metres; 0 is unlimited
    float inner_cone = 0; ///< of a spot: radians from its axis within which it is not dimmed
    float outer_cone = 0.7853982f; ///< radians from its axis at which it ends
};

struct SceneCamera {
    std::string name;
    Index node = none;
    Projection projection = Projection::perspective;
    float vertical_extent = 0.8f; ///< as in Camera
};

/// A compact one takes three fifths of the memory of a fast one; rays take a sixth longer.
enum class BvhKind : std::uint8_t { fast, compact };

struct Scene {
    std::string name;
    BvhKind bvh = BvhKind::fast; ///< how it is to be built
    std::string light; ///< by which method the files want it to be lit, a word of --light; empty: by any
    std::vector<std::shared_ptr<Picture const>> images; ///< bytes as stored in the file
    std::vector<Texture> textures;
    std::vector<Material> materials;
    std::vector<Mesh> meshes;
    std::vector<Node> nodes;
    std::vector<Skin> skins;
    std::vector<AnimationClip> clips;
    std::vector<Light> lights;
    std::vector<SceneCamera> cameras;
    /// Where the files have the point that is (0, 0, 0) to whoever renders and looks; `evaluate_pose` leaves it out.
    glm::dvec3 origin{0, 0, 0};
    bool is_truncated = false; ///< a file ends before all that it promises, as one does that is being written
    std::vector<std::string> warnings; ///< one line each: what of the file was passed over
    /// Files that the scene is made of, whether they exist or not; the scene files first.
    std::vector<std::filesystem::path> files;
    std::size_t scene_files = 1; ///< how many of `files` are scene files; the others are what these name
};

} // namespace framelet
