#include "server/scene/finish/scene_finish.h"

#include <mutex>

#include <tbb/parallel_for.h>

#include "common/counted.h"
#include "common/error.h"
#include "server/scene/finish/finish_parts.h"
#include "server/scene/finish/primitive_finish.h"
#include "server/scene/finish/primitive_ops.h"
#include "server/scene/finish/scene_origin.h"
#include "server/scene/motion/animation.h"
#include "server/scene/reading/image_loading.h"
#include "server/scene/vector_math.h"

namespace framelet {
namespace {

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
        for (TextureUse* const use : texture_uses(m)) {
            for (float* value : {&use->offset.x, &use->offset.y, &use->rotation}) {
                *value = clamped(*value, -max_coordinate, max_coordinate, 0);
            }
            use->scale.x = clamped(use->scale.x, -max_coordinate, max_coordinate, 1);
            use->scale.y = clamped(use->scale.y, -max_coordinate, max_coordinate, 1);
        }
    }
}

void finish_meshes(Scene& scene, ImportBudget& budget, Progress const& progress) {
    struct Job {
        std::size_t mesh, primitive;
        PrimitiveRepairs repairs;
        std::vector<std::string> faults; ///< why it cannot be shown; empty: it can
    };
    std::vector<Job> jobs;
    std::size_t triangles = 0;
    for (std::size_t m = 0; m < scene.meshes.size(); ++m) {
        std::erase_if(scene.meshes[m].primitives, [](Primitive const& p) { return p.triangles.empty(); });
        for (std::size_t p = 0; p < scene.meshes[m].primitives.size(); ++p) {
            jobs.push_back({m, p, {}, {}});
            Primitive const& primitive = scene.meshes[m].primitives[p];
            triangles += primitive.triangles.size();
            if (primitive.normals.empty()) { // flat shading gives every triangle its own vertices
                budget.reserve(primitive.triangles.size() * 3, bytes_per_vertex(primitive) + sizeof(Vec3));
            }
        }
    }
    if (triangles > 0) {
        progress("meshes", 0);
    }
    std::mutex report;
    std::size_t done = 0; // triangles
    tbb::parallel_for(std::size_t(0), jobs.size(), [&](std::size_t i) {
        Mesh& mesh = scene.meshes[jobs[i].mesh];
        Primitive& primitive = mesh.primitives[jobs[i].primitive];
        std::size_t const count = primitive.triangles.size();
        Faults(named("mesh", jobs[i].mesh, mesh.name), jobs[i].faults)
            .tried(
                [&] {
                    jobs[i].repairs =
                        finish_primitive(primitive, scene.materials[static_cast<std::size_t>(primitive.material)]);
                },
                "; that part is not shown");
        std::lock_guard const lock(report);
        done += count;
        progress("meshes", static_cast<double>(done) / static_cast<double>(triangles));
    });
    std::size_t normals = 0;
    std::size_t other = 0;
    std::size_t broken = 0;
    for (Job const& job : jobs) {
        normals += job.repairs.normals;
        other += job.repairs.other;
        if (!job.faults.empty()) {
            ++broken;
            scene.warnings.insert(scene.warnings.end(), job.faults.begin(), job.faults.end());
            scene.meshes[job.mesh].primitives[job.primitive].triangles.clear();
        }
    }
    if (broken > 0 && broken == jobs.size()) {
        throw InputError(scene.warnings[scene.warnings.size() - broken]);
    }
    for (Mesh& mesh : scene.meshes) {
        std::erase_if(mesh.primitives, [](Primitive const& primitive) { return primitive.triangles.empty(); });
    }
    if (normals > 0) {
        scene.warnings.push_back(counted(normals, "unusable normal") + " taken from the triangles");
    }
    if (other > 0) {
        scene.warnings.push_back(counted(other, "texture coordinate, colour or morph offset",
                                         "texture coordinates, colours and morph offsets") +
                                 " left out for not being numbers");
    }
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

/// Drops cameras beyond those that anybody would choose from, and that a Welcome has room for.
void finish_cameras(Scene& scene) {
    constexpr std::size_t most_cameras = 4096;
    if (std::size_t const all = scene.cameras.size(); all > most_cameras) {
        scene.cameras.erase(scene.cameras.begin() + most_cameras, scene.cameras.end());
        scene.warnings.push_back("it has " + std::to_string(all) + " cameras; the first " +
                                 std::to_string(most_cameras) + " can be chosen");
    }
    for (SceneCamera& camera : scene.cameras) {
        bool const perspective = camera.projection == Projection::perspective;
        float const largest = perspective ? 3.1f : max_coordinate;
        if (!(camera.vertical_extent > 1e-4f && camera.vertical_extent <= largest)) {
            scene.warnings.push_back("camera '" + camera.name + "' has an unusable field of view; 0.8 is used");
            camera.vertical_extent = 0.8f;
        }
    }
}

/// Reserves what a node takes for itself although it shares its mesh: weights of morph targets, and the vertices of
/// what deforms.
void reserve_copies(Scene const& scene, ImportBudget& budget) {
    constexpr std::size_t vertex_bytes = 3 * sizeof(Vec3) + sizeof(Vec4); // position, normal, velocity, tangent
    for (Node const& node : scene.nodes) {
        if (node.mesh == none) {
            continue;
        }
        Mesh const& mesh = scene.meshes[static_cast<std::size_t>(node.mesh)];
        budget.reserve(mesh.morph_weights.size(), sizeof(float));
        if (node.skin == none && mesh.morph_weights.empty()) {
            continue;
        }
        for (Primitive const& primitive : mesh.primitives) {
            budget.reserve(primitive.positions.size(), vertex_bytes);
        }
    }
}

/// Scales that are each in range may still multiply to something that is not: the first node whose place is out of
/// range loses its transform.
void finish_placement(Scene& scene) {
    std::vector<glm::dmat4> world(scene.nodes.size());
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node& node = scene.nodes[i];
        glm::dmat4 const above = node.parent == none ? glm::dmat4(1) : world[static_cast<std::size_t>(node.parent)];
        world[i] = above * (node.matrix ? *node.matrix : matrix_of(node.local));
        bool ok = true;
        for (int c = 0; c < 4; ++c) {
            ok = ok && glm::length(glm::dvec3(world[i][c])) <= max_coordinate;
        }
        if (!ok) {
            scene.warnings.push_back(named("node", i, node.name) +
                                     " is placed out of range; its transform is passed over");
            node.local = {};
            node.matrix.reset();
            world[i] = above;
        }
    }
}

} // namespace

void finish_scene(Scene& scene, ImportBudget& budget, Progress const& progress) {
    drop_missing_images(scene);
    finish_materials(scene);
    finish_meshes(scene, budget, progress);
    finish_nodes(scene);
    finish_clips(scene);
    finish_placement(scene);
    set_origin(scene);
    centre_meshes(scene);
    reserve_copies(scene, budget);
    finish_lights(scene);
    finish_cameras(scene);
}

} // namespace framelet
