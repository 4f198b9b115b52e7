#include "server/scene/scene_finish.h"

#include <algorithm>
#include <mutex>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "server/scene/animation.h"
#include "server/scene/image_loading.h"
#include "server/scene/primitive_finish.h"
#include "server/scene/vector_math.h"

namespace framelet {
namespace {

std::string named(char const* kind, std::size_t index, std::string const& name) {
    return std::string(kind) + " " + std::to_string(index) + (name.empty() ? "" : " '" + name + "'");
}

bool in_range(float value) {
    return std::abs(value) <= max_coordinate;
}

float clamped(float value, float low, float high, float otherwise) {
    return std::isfinite(value) ? std::clamp(value, low, high) : otherwise;
}

void finish_materials(Scene& scene) {
    auto const default_material = static_cast<Index>(scene.materials.size());
    bool needed = false;
    for (Mesh& mesh : scene.meshes) {
        for (Primitive& primitive : mesh.primitives) {
            if (primitive.material < 0) {
                primitive.material = default_material;
                needed = true;
            } else if (primitive.material >= default_material) {
                throw InputError("material " + std::to_string(primitive.material) + " does not exist");
            }
        }
    }
    if (needed) {
        scene.materials.emplace_back();
    }
    for (Material& m : scene.materials) {
        for (int c = 0; c < 4; ++c) {
            m.base_color[c] = clamped(m.base_color[c], 0, 1, 1);
        }
        for (int c = 0; c < 3; ++c) {
            m.emissive[c] = clamped(m.emissive[c], 0, max_coordinate, 0);
        }
        m.metallic = clamped(m.metallic, 0, 1, 1);
        m.roughness = clamped(m.roughness, 0, 1, 1);
        m.normal_scale = clamped(m.normal_scale, -max_coordinate, max_coordinate, 1);
        m.occlusion_strength = clamped(m.occlusion_strength, 0, 1, 1);
        m.transmission = clamped(m.transmission, 0, 1, 0);
        m.alpha_cutoff = clamped(m.alpha_cutoff, 0, max_coordinate, 0.5f);
        for (TextureUse* use : {&m.base_color_texture, &m.metallic_roughness_texture, &m.normal_texture,
                                &m.occlusion_texture, &m.emissive_texture, &m.transmission_texture}) {
            for (float* value : {&use->offset.x, &use->offset.y, &use->rotation}) {
                *value = clamped(*value, -max_coordinate, max_coordinate, 0);
            }
            use->scale.x = clamped(use->scale.x, -max_coordinate, max_coordinate, 1);
            use->scale.y = clamped(use->scale.y, -max_coordinate, max_coordinate, 1);
        }
    }
}

void finish_meshes(Scene& scene, Progress const& progress) {
    struct Job {
        std::size_t mesh, primitive;
        PrimitiveRepairs repairs;
    };
    std::vector<Job> jobs;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        std::erase_if(scene.meshes[m].primitives, [](Primitive const& p) { return p.triangles.empty(); });
        for (std::size_t p = 0; p < scene.meshes[m].primitives.size(); ++p) {
            jobs.push_back({m, p, {}});
        }
    }
    std::mutex report;
    std::size_t done = 0;
    tbb::parallel_for(std::size_t(0), jobs.size(), [&](std::size_t i) {
        Mesh& mesh = scene.meshes[jobs[i].mesh];
        Primitive& primitive = mesh.primitives[jobs[i].primitive];
        try {
            jobs[i].repairs =
                finish_primitive(primitive, scene.materials[static_cast<std::size_t>(primitive.material)]);
        } catch (InputError const& error) {
            throw InputError(named("mesh", jobs[i].mesh, mesh.name) + ": " + error.what());
        }
        std::lock_guard const lock(report);
        progress("meshes", static_cast<double>(++done) / static_cast<double>(jobs.size()));
    });
    for (Job const& job : jobs) {
        std::string const what = named("mesh", job.mesh, scene.meshes[job.mesh].name);
        if (job.repairs.normals > 0) {
            scene.warnings.push_back(what + ": " + std::to_string(job.repairs.normals) +
                                     " unusable normals were taken from the triangles");
        }
        if (job.repairs.other > 0) {
            scene.warnings.push_back(what + ": " + std::to_string(job.repairs.other) +
                                     " texture coordinates, colours or morph offsets are not numbers");
        }
    }
}

/// Weights exist for every morph target: missing ones are 0, those too many are dropped.
void finish_morph_weights(Scene& scene) {
    auto const repair = [](std::vector<float>& weights, std::size_t targets) {
        weights.resize(targets);
        for (float& weight : weights) {
            weight = clamped(weight, -max_coordinate, max_coordinate, 0);
        }
    };
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        Mesh& mesh = scene.meshes[i];
        std::size_t const targets = mesh.primitives.empty() ? 0 : mesh.primitives.front().morph_targets.size();
        for (Primitive const& primitive : mesh.primitives) {
            if (primitive.morph_targets.size() != targets) {
                throw InputError(named("mesh", i, mesh.name) + ": its primitives have different morph targets");
            }
        }
        repair(mesh.morph_weights, targets);
    }
    for (Node& node : scene.nodes) {
        if (node.mesh == none) {
            node.morph_weights.clear();
        } else if (!node.morph_weights.empty()) {
            repair(node.morph_weights, scene.meshes[static_cast<std::size_t>(node.mesh)].morph_weights.size());
        }
    }
}

void finish_nodes(Scene& scene) {
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node& node = scene.nodes[i];
        FRAMELET_CHECK(node.parent >= none && node.parent < static_cast<Index>(i));
        FRAMELET_CHECK(node.mesh >= none && node.mesh < static_cast<Index>(scene.meshes.size()));
        Transform& local = node.local;
        Quat const& q = local.rotation;
        bool ok = in_range(q.x) && in_range(q.y) && in_range(q.z) && in_range(q.w);
        for (int c = 0; c < 3; ++c) {
            ok = ok && in_range(local.translation[c]) && in_range(local.scale[c]);
        }
        if (node.matrix) {
            for (int column = 0; column < 4; ++column) {
                Vec4& v = (*node.matrix)[column];
                v.w = column == 3 ? 1.0f : 0.0f;
                ok = ok && in_range(v.x) && in_range(v.y) && in_range(v.z);
            }
        }
        if (!ok) {
            throw InputError(named("node", i, node.name) + " has a transform that is not a number or out of range");
        }
        float const length = glm::length(local.rotation);
        local.rotation = length > 0 ? local.rotation / length : Quat(1, 0, 0, 0);
    }
}

/// Skins whose joints are all in the scene and whose influences name joints that exist; others are taken off.
void finish_skins(Scene& scene) {
    std::vector<bool> usable;
    for (std::size_t i = 0; i < scene.skins.size(); ++i) {
        Skin& skin = scene.skins[i];
        FRAMELET_CHECK(skin.joints.size() == skin.inverse_bind_matrices.size());
        bool const complete = std::find(skin.joints.begin(), skin.joints.end(), none) == skin.joints.end();
        usable.push_back(complete && !skin.joints.empty());
        if (!complete) {
            scene.warnings.push_back(named("skin", i, "") + " has joints outside the scene; shown without it");
            skin = {};
        }
        for (Mat4 const& matrix : skin.inverse_bind_matrices) {
            for (int c = 0; c < 4; ++c) {
                if (!(glm::length(matrix[c]) <= max_coordinate)) {
                    throw InputError(named("skin", i, "") + " has an inverse bind matrix that is not a number");
                }
            }
        }
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node& node = scene.nodes[i];
        if (node.skin == none || node.mesh == none) {
            node.skin = none;
            continue;
        }
        std::size_t const joints = scene.skins[static_cast<std::size_t>(node.skin)].joints.size();
        Mesh& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
        bool any = false;
        bool all = true;
        for (Primitive const& primitive : mesh.primitives) {
            any = any || !primitive.influences.empty();
            all = all && !primitive.influences.empty();
        }
        if (!usable[static_cast<std::size_t>(node.skin)] || !any) {
            node.skin = none;
            continue;
        }
        for (Primitive& primitive : mesh.primitives) {
            if (!all && primitive.influences.empty()) { // scene.h promises influences where a node has a skin
                primitive.influences.assign(primitive.positions.size(), JointInfluence{{}, {1, 0, 0, 0}});
            }
            for (JointInfluence const& influence : primitive.influences) {
                for (std::uint16_t const joint : influence.joints) {
                    if (joint >= joints) {
                        throw InputError(named("mesh", static_cast<std::size_t>(node.mesh), mesh.name) +
                                         " uses joint " + std::to_string(joint) + " of a skin with " +
                                         std::to_string(joints));
                    }
                }
            }
        }
    }
}

/// Takes a matrix apart into translation, rotation and scale; shear is lost.
Transform decompose(Mat4 const& matrix) {
    Transform result;
    result.translation = Vec3(matrix[3]);
    Mat3 axes(matrix);
    for (int c = 0; c < 3; ++c) {
        result.scale[c] = glm::length(axes[c]);
        axes[c] = unit_or(axes[c], Vec3(0));
    }
    if (glm::dot(glm::cross(axes[0], axes[1]), axes[2]) < 0) {
        result.scale.x = -result.scale.x;
        axes[0] = -axes[0];
    }
    Quat const rotation = glm::quat_cast(axes);
    float const length = glm::length(rotation);
    result.rotation = length > 0 ? rotation / length : Quat(1, 0, 0, 0);
    return result;
}

/// Drops keys whose time does not increase.
std::size_t drop_repeated_keys(AnimationChannel& channel) {
    std::size_t const width = channel.values.size() / channel.times.size();
    std::size_t kept = 0;
    for (std::size_t key = 0; key < channel.times.size(); ++key) {
        if (kept == 0 || channel.times[key] > channel.times[kept - 1]) {
            channel.times[kept] = channel.times[key];
            std::copy_n(channel.values.begin() + static_cast<std::ptrdiff_t>(key * width), width,
                        channel.values.begin() + static_cast<std::ptrdiff_t>(kept * width));
            ++kept;
        }
    }
    std::size_t const dropped = channel.times.size() - kept;
    channel.times.resize(kept);
    channel.values.resize(kept * width);
    return dropped;
}

/// True when the channel can be played; throws where its numbers are no numbers.
bool finish_channel(Scene& scene, AnimationClip const& clip, AnimationChannel& channel) {
    Node& node = scene.nodes[static_cast<std::size_t>(channel.node)];
    std::string const what = "animation '" + clip.name + "'";
    auto const finite = [](float value) { return in_range(value); };
    if (!std::all_of(channel.times.begin(), channel.times.end(), finite) ||
        !std::all_of(channel.values.begin(), channel.values.end(), finite)) {
        throw InputError(what + " has keys that are not numbers");
    }
    if (std::size_t const dropped = drop_repeated_keys(channel)) {
        scene.warnings.push_back(what + ": " + std::to_string(dropped) +
                                 " keys whose time does not increase are dropped");
    }
    if (channel.property == AnimatedProperty::morph_weights) {
        std::size_t const targets =
            node.mesh == none ? 0 : scene.meshes[static_cast<std::size_t>(node.mesh)].morph_weights.size();
        if (targets != static_cast<std::size_t>(channel.components)) {
            scene.warnings.push_back(what + " has " + std::to_string(channel.components) + " weights for " +
                                     std::to_string(targets) + " morph targets; passed over");
            return false;
        }
    } else if (node.matrix) {
        node.local = decompose(*node.matrix);
        node.matrix.reset();
    }
    return true;
}

void finish_clips(Scene& scene) {
    for (AnimationClip& clip : scene.clips) {
        std::erase_if(clip.channels, [&](AnimationChannel& channel) { return !finish_channel(scene, clip, channel); });
        clip.duration = 0;
        for (AnimationChannel const& channel : clip.channels) {
            clip.duration = std::max(clip.duration, channel.times.back());
        }
    }
    std::erase_if(scene.clips, [](AnimationClip const& clip) { return clip.channels.empty(); });
}

void finish_lights(Scene& scene) {
    constexpr float quarter_turn = 1.5707963f;
    for (Light& light : scene.lights) {
        for (int c = 0; c < 3; ++c) {
            light.color[c] = clamped(light.color[c], 0, max_coordinate, 1);
        }
        light.intensity = clamped(light.intensity, 0, max_coordinate, 1);
        light.range = clamped(light.range, 0, max_coordinate, 0);
        light.outer_cone = clamped(light.outer_cone, 1e-3f, quarter_turn, 0.7853982f);
        light.inner_cone = clamped(light.inner_cone, 0, light.outer_cone - 1e-4f, 0);
    }
}

void finish_cameras(Scene& scene) {
    for (SceneCamera& camera : scene.cameras) {
        bool const perspective = camera.projection == Projection::perspective;
        float const largest = perspective ? 3.1f : max_coordinate;
        if (!(camera.vertical_extent > 1e-4f && camera.vertical_extent <= largest)) {
            scene.warnings.push_back("camera '" + camera.name + "' has an unusable field of view; 0.8 is used");
            camera.vertical_extent = 0.8f;
        }
        camera.aspect_ratio = clamped(camera.aspect_ratio, 0, 1e4f, 0);
    }
}

/// Scales that are each in range may still multiply to something that is not.
void check_placement(Scene const& scene) {
    ScenePose const pose = evaluate_pose(scene, default_clips(scene), 0);
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        for (int c = 0; c < 4; ++c) {
            if (!(glm::length(Vec3(pose.world_from_node[i][c])) <= max_coordinate)) {
                throw InputError(named("node", i, scene.nodes[i].name) + " is placed out of range");
            }
        }
    }
}

} // namespace

void finish_scene(Scene& scene, Progress const& progress) {
    drop_missing_images(scene);
    finish_materials(scene);
    finish_meshes(scene, progress);
    finish_morph_weights(scene);
    finish_nodes(scene);
    finish_skins(scene);
    finish_clips(scene);
    finish_lights(scene);
    finish_cameras(scene);
    check_placement(scene);
}

} // namespace framelet
