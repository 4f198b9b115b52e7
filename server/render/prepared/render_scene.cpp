#include "server/render/prepared/render_scene.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <span>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/matrix.hpp>
#include <tbb/parallel_for.h>

#include "common/error.h"
#include "server/render/flush_denormals.h"
#include "server/render/prepared/prepared_scene.h"
#include "server/scene/finish/scene_memory.h"

namespace framelet {
namespace {

/// False for transforms that flatten or shrink to nothing: rays cannot be taken into their space.
bool invertible(Mat3 const& m) {
    float const lengths = glm::length(m[0]) * glm::length(m[1]) * glm::length(m[2]);
    if (!(lengths > 1e-30f && lengths < 1e30f && std::abs(glm::determinant(m)) > 1e-6f * lengths)) {
        return false;
    }
    Mat3 const inverse = glm::inverse(m);
    float largest = 0;
    for (int c = 0; c < 3; ++c) {
        for (int r = 0; r < 3; ++r) {
            largest = std::max(largest, std::abs(inverse[c][r]));
        }
    }
    return largest < 1 / least_instance_scale;
}

/// The transform, or where it flattens space to a plane one that leaves a little of the third direction: what is
/// flattened shows.
Mat3 traceable_transform(Mat3 const& m) {
    constexpr float thickness = 1e-5f; // of its size
    if (invertible(m)) {
        return m;
    }
    // Its cofactors, of one such matrix, lead from the direction that is lost to the normal of the plane.
    Mat3 const cofactors(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    auto const length = [](Mat3 const& of) {
        return std::sqrt(glm::dot(of[0], of[0]) + glm::dot(of[1], of[1]) + glm::dot(of[2], of[2]));
    };
    float const size = length(m);
    float const area = length(cofactors);
    bool const is_plane = area > 1e-6f * size * size;
    float const side = glm::determinant(m) < 0 ? -1.0f : 1.0f;
    return is_plane ? m + cofactors * (side * thickness * size / area) : m;
}

std::vector<Geometry> geometries_of(Mesh const& mesh, MaterialLibrary const& library) {
    std::vector<Geometry> out;
    for (Primitive const& primitive : mesh.primitives) {
        std::size_t const last = library.materials.size() - 1; // the default one
        bool const known = primitive.material >= 0 && static_cast<std::size_t>(primitive.material) < last;
        Geometry geometry;
        geometry.source = &primitive;
        geometry.material = &library.materials[known ? static_cast<std::size_t>(primitive.material) : last];
        geometry.normals = primitive.normals;
        geometry.tangents = primitive.tangents;
        out.push_back(geometry);
    }
    return out;
}

/// The surroundings of a scene with lights and no map: under a sun the sky that belongs to it, else just enough light
/// to tell the shapes in the shade apart.
Environment surroundings_of_lights(Scene const& scene) {
    float suns = 0;
    for (Light const& light : scene.lights) {
        suns += light.type == LightType::directional ? std::clamp(light.intensity, 0.0f, 1e6f) : 0.0f;
    }
    constexpr float light_share = 0.4f; // many scenes with a sun are rooms
    return suns > 0 ? Environment::default_sky(suns / default_sun().intensity.r, light_share)
                    : Environment::uniform(Vec3(0.05f));
}

} // namespace

RenderScene::RenderScene(Scene const& scene, std::optional<Environment> environment, Progress const& progress)
    : scene_(scene), prepared_(std::make_unique<PreparedScene>()), pose_(evaluate_pose(scene, {}, 0)) {
    FlushDenormals const flush;
    auto report = [&](char const* what, double fraction) {
        if (progress) {
            progress(what, fraction);
        }
    };
    report("preparing textures", 0);
    prepared_->library = make_materials(scene, progress);
    prepared_->see_through =
        std::ranges::any_of(prepared_->library.materials, [](RenderMaterial const& m) { return m.see_through(); });
    prepared_->bvh.build_as(scene.bvh);
    add_meshes(progress);
    report("preparing light", 0);
    if (environment) {
        prepared_->environment = std::move(*environment);
    } else {
        prepared_->environment = scene.lights.empty() ? Environment::default_sky() : surroundings_of_lights(scene);
        if (scene.lights.empty()) {
            prepared_->lights.push_back(default_sun());
        }
    }
    set_pose(pose_); // places everything
    report("preparing light", 1);
}

RenderScene::~RenderScene() = default;

void RenderScene::set_light(LightCache* cache, LampSizes sizes) {
    prepared_->light_cache = cache;
    prepared_->lamp_sizes = sizes;
}

void RenderScene::set_display(DisplayTransform const& display) {
    prepared_->display = display;
}

void RenderScene::add_meshes(Progress const& progress) {
    std::map<Index, std::uint32_t> shared;
    double const all = static_cast<double>(std::max<std::uint64_t>(triangles_to_build(scene_), 1));
    double built = 0; // triangles
    auto const report = [&](double triangles) {
        if (progress) {
            progress("building the BVH", triangles / all);
        }
    };
    report(0);
    for (std::size_t node = 0; node < scene_.nodes.size(); ++node) {
        Node const& n = scene_.nodes[node];
        if (n.mesh == none) {
            continue;
        }
        Mesh const& mesh = scene_.meshes[static_cast<std::size_t>(n.mesh)];
        Skin const* skin = n.skin == none ? nullptr : &scene_.skins[static_cast<std::size_t>(n.skin)];
        bool const deforming = is_deforming(scene_, n);
        auto const known = shared.find(n.mesh);
        std::uint32_t id = 0;
        if (!deforming && known != shared.end()) {
            id = known->second;
        } else {
            prepared_->meshes.push_back(geometries_of(mesh, prepared_->library));
            auto const count = static_cast<double>(count_triangles(mesh));
            std::function<void(double)> part;
            if (progress) {
                part = [&](double fraction) { report(built + count * std::min(fraction, 1.0)); };
            }
            id = prepared_->bvh.add_mesh(prepared_->meshes.back(), deforming, part);
            built += count;
            report(built);
            if (!deforming) {
                shared[n.mesh] = id;
            }
        }
        placements_.push_back({node, id, prepared_->bvh.add_instance(id), skin, morphs(mesh), deformed_.size()});
        if (deforming) {
            deformed_.emplace_back(mesh.primitives.size());
        }
    }
    prepared_->instances.resize(placements_.size());
}

/// Builds every BVH anew, with the numbers that it had.
void RenderScene::build_anew() {
    is_built_ = false;
    is_placed_ = false;
    prepared_->bvh.clear();
    std::size_t built = 0;
    for (Placement const& placement : placements_) {
        if (placement.mesh == built) { // meshes were numbered as they were first placed
            prepared_->bvh.add_mesh(prepared_->meshes[built++], placement.deforms());
        }
        prepared_->bvh.add_instance(placement.mesh);
    }
    is_built_ = true;
}

void RenderScene::set_transform(Placement const& placement) {
    Mat4 const world = placement.skin ? Mat4(1) : pose_.world_from_node[placement.node];
    Instance& instance = prepared_->instances[placement.instance];
    instance.geometries = prepared_->meshes[placement.mesh];
    instance.linear = traceable_transform(Mat3(world));
    instance.translation = Vec3(world[3]);
    bool const present = invertible(instance.linear) && traceable(instance.translation);
    if (present) {
        instance.normal_matrix = glm::inverseTranspose(instance.linear);
        instance.handedness = glm::determinant(instance.linear) < 0 ? -1.0f : 1.0f;
    }
    prepared_->bvh.set_instance(placement.instance, instance.linear, instance.translation, present);
}

void RenderScene::deform_mesh(Placement const& placement) {
    Node const& node = scene_.nodes[placement.node];
    Mesh const& mesh = scene_.meshes[static_cast<std::size_t>(node.mesh)];
    MeshVertices& vertices = deformed_[placement.deformed];
    for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
        Geometry& geometry = prepared_->meshes[placement.mesh][i];
        DeformedVertices& moved_to = vertices[i];
        deform(mesh.primitives[i], pose_.morph_weights[placement.node], placement.skin, pose_, moved_to);
        if (std::span<Vec3> const positions = prepared_->bvh.positions(placement.mesh, i); !positions.empty()) {
            std::ranges::copy(moved_to.positions, positions.begin());
        }
        geometry.normals = moved_to.normals;
        geometry.tangents = moved_to.tangents;
    }
    prepared_->bvh.refit_mesh(placement.mesh);
}

bool RenderScene::moved(Placement const& placement, ScenePose const& pose) const {
    return !placement.skin && pose.world_from_node[placement.node] != pose_.world_from_node[placement.node];
}

bool RenderScene::reshaped(Placement const& placement, ScenePose const& pose) const {
    if (placement.morphs && pose.morph_weights[placement.node] != pose_.morph_weights[placement.node]) {
        return true;
    }
    return placement.skin && std::ranges::any_of(placement.skin->joints, [&](Index joint) {
               std::size_t const node = static_cast<std::size_t>(joint);
               return pose.world_from_node[node] != pose_.world_from_node[node];
           });
}

void RenderScene::set_pose(ScenePose const& pose) {
    FRAMELET_CHECK(pose.world_from_node.size() == scene_.nodes.size());
    FRAMELET_CHECK(pose.morph_weights.size() == scene_.nodes.size());
    FlushDenormals const flush;
    if (prepared_->bvh.is_broken() || !is_built_) {
        build_anew();
    }
    std::vector<Placement const*> move, reshape;
    for (Placement const& placement : placements_) {
        if (reshaped(placement, pose) || (!is_placed_ && placement.deforms())) {
            reshape.push_back(&placement);
        } else if (moved(placement, pose) || !is_placed_) {
            move.push_back(&placement);
        }
    }
    is_placed_ = false;
    pose_ = pose;
    update_lights();
    tbb::parallel_for(std::size_t{0}, reshape.size(), [&](std::size_t i) { deform_mesh(*reshape[i]); });
    for (Placement const* placement : reshape) {
        set_transform(*placement); // its box has changed
    }
    for (Placement const* placement : move) {
        set_transform(*placement);
    }
    if (!move.empty() || !reshape.empty()) {
        prepared_->bvh.commit();
    }
    update_motion();
    is_placed_ = true;
}

void RenderScene::update_lights() {
    if (scene_.lights.empty()) {
        return;
    }
    prepared_->lights.clear();
    for (Light const& light : scene_.lights) {
        prepared_->lights.push_back(make_light(light, pose_));
    }
}

} // namespace framelet
