#include <algorithm>
#include <map>
#include <utility>

#include <assimp/scene.h>

#include "common/camera.h"
#include "common/error.h"
#include "server/scene/assimp/assimp_parts.h"
#include "server/scene/vector_math.h"

namespace framelet {
namespace {

Vec3 to_vec3(aiVector3D const& v) {
    return {v.x, v.y, v.z};
}

Mat4 to_mat4(aiMatrix4x4 const& m) { // Assimp's are row by row
    return {m.a1, m.b1, m.c1, m.d1, m.a2, m.b2, m.c2, m.d2, m.a3, m.b3, m.c3, m.d3, m.a4, m.b4, m.c4, m.d4};
}

/// Transform of what stands at `position` and looks along -`back`; `right` and `back` are unit, at right angles.
Mat4 placed(Vec3 const& right, Vec3 const& back, aiVector3D const& position) {
    return Mat4(Vec4(right, 0), Vec4(glm::cross(back, right), 0), Vec4(back, 0), Vec4(to_vec3(position), 1));
}

/// Bytes that a mesh takes once it is imported, roughly: with all that a vertex may have.
std::uint64_t imported_bytes(aiMesh const& mesh) {
    std::uint64_t const vertex_bytes = 3 * sizeof(Vec3) + 2 * sizeof(Vec2) + sizeof(Vec4) +
                                       (mesh.mNumBones > 0 ? sizeof(JointInfluence) : 0) +
                                       mesh.mNumAnimMeshes * std::uint64_t(2 * sizeof(Vec3));
    return mesh.mNumVertices * vertex_bytes + mesh.mNumFaces * std::uint64_t(sizeof(Primitive::triangles[0]));
}

struct Builder {
    aiScene const& from;
    ImportBudget& budget;
    Scene& scene;
    std::map<std::string, Index> node_by_name;
    std::map<std::vector<unsigned>, Index> mesh_by_parts; ///< instances share a mesh

    Index find(aiString const& name) const {
        auto const found = node_by_name.find(name.C_Str());
        return found == node_by_name.end() ? none : found->second;
    }

    Index add_node(std::string name, Index parent, Mat4 const& local) {
        Node node;
        node.name = std::move(name);
        node.parent = parent;
        node.matrix = local;
        scene.nodes.push_back(std::move(node));
        return static_cast<Index>(scene.nodes.size()) - 1;
    }

    Index find_mesh(std::vector<unsigned> const& parts) {
        auto const [found, added] = mesh_by_parts.try_emplace(parts, static_cast<Index>(scene.meshes.size()));
        if (added) {
            Mesh mesh;
            mesh.name = from.mMeshes[parts.front()]->mName.C_Str();
            for (unsigned const part : parts) {
                budget.reserve(1, imported_bytes(*from.mMeshes[part]));
                mesh.primitives.push_back(import_assimp_primitive(*from.mMeshes[part]));
            }
            aiMesh const& first = *from.mMeshes[parts.front()];
            for (unsigned t = 0; t < first.mNumAnimMeshes; ++t) {
                mesh.morph_weights.push_back(first.mAnimMeshes[t]->mWeight);
            }
            scene.meshes.push_back(std::move(mesh));
        }
        return found->second;
    }

    /// All rigid parts of a node become one mesh; every skinned or morphing one gets a node of its own.
    void add_meshes(aiNode const& node, Index index) {
        std::vector<unsigned> rigid;
        for (unsigned i = 0; i < node.mNumMeshes; ++i) {
            aiMesh const& mesh = *from.mMeshes[node.mMeshes[i]];
            if (mesh.mNumBones == 0 && mesh.mNumAnimMeshes == 0) {
                rigid.push_back(node.mMeshes[i]);
                continue;
            }
            Index const child = add_node(mesh.mName.C_Str(), index, Mat4(1));
            Index const imported = find_mesh({node.mMeshes[i]});
            scene.nodes[static_cast<std::size_t>(child)].mesh = imported;
        }
        if (!rigid.empty()) {
            Index const imported = find_mesh(rigid);
            scene.nodes[static_cast<std::size_t>(index)].mesh = imported;
        }
    }

    void add_nodes() {
        std::vector<std::pair<aiNode const*, Index>> pending{{from.mRootNode, none}};
        while (!pending.empty()) {
            auto const [node, parent] = pending.back();
            pending.pop_back();
            Index const index = add_node(node->mName.C_Str(), parent, to_mat4(node->mTransformation));
            node_by_name.try_emplace(node->mName.C_Str(), index);
            add_meshes(*node, index);
            for (unsigned i = node->mNumChildren; i > 0; --i) {
                pending.emplace_back(node->mChildren[i - 1], index);
            }
        }
    }

    /// Adds a skin for every node whose mesh has bones, and the four strongest bones of its vertices.
    void add_skins() {
        for (auto const& [parts, mesh_index] : mesh_by_parts) {
            aiMesh const& mesh = *from.mMeshes[parts.front()];
            if (mesh.mNumBones == 0) {
                continue;
            }
            Primitive& primitive = scene.meshes[static_cast<std::size_t>(mesh_index)].primitives.front();
            primitive.influences.assign(primitive.positions.size(), {});
            Skin skin;
            for (unsigned b = 0; b < mesh.mNumBones && b <= 0xffff; ++b) {
                aiBone const& bone = *mesh.mBones[b];
                skin.joints.push_back(find(bone.mName));
                skin.inverse_bind_matrices.push_back(to_mat4(bone.mOffsetMatrix));
                for (unsigned w = 0; w < bone.mNumWeights; ++w) {
                    aiVertexWeight const& weight = bone.mWeights[w];
                    if (weight.mVertexId >= primitive.influences.size()) {
                        throw InputError("a bone moves vertex " + std::to_string(weight.mVertexId) +
                                         ", which is missing");
                    }
                    JointInfluence& influence = primitive.influences[weight.mVertexId];
                    auto const weakest = std::min_element(influence.weights.begin(), influence.weights.end());
                    if (weight.mWeight > *weakest) {
                        *weakest = weight.mWeight;
                        influence.joints[static_cast<std::size_t>(weakest - influence.weights.begin())] =
                            static_cast<std::uint16_t>(b);
                    }
                }
            }
            for (Node& node : scene.nodes) {
                if (node.mesh == mesh_index) {
                    node.skin = static_cast<Index>(scene.skins.size());
                }
            }
            scene.skins.push_back(std::move(skin));
        }
    }

    void add_cameras() {
        for (unsigned i = 0; i < from.mNumCameras; ++i) {
            aiCamera const& source = *from.mCameras[i];
            Vec3 const back = unit_or(-to_vec3(source.mLookAt), Vec3(0, 0, 1));
            Vec3 const right =
                unit_or(glm::cross(unit_or(to_vec3(source.mUp), Vec3(0, 1, 0)), back), any_perpendicular(back));
            SceneCamera camera;
            camera.name = source.mName.C_Str();
            camera.node = add_node(camera.name, find(source.mName), placed(right, back, source.mPosition));
            float const aspect = source.mAspect > 0 ? source.mAspect : 16.0f / 9.0f;
            if (source.mOrthographicWidth > 0) {
                camera.projection = Projection::orthographic;
                camera.vertical_extent = 2 * source.mOrthographicWidth / aspect;
            } else {
                camera.vertical_extent = 2 * std::atan(std::tan(0.5f * source.mHorizontalFOV) / aspect);
            }
            scene.cameras.push_back(camera);
        }
    }

    void add_lights() {
        for (unsigned i = 0; i < from.mNumLights; ++i) {
            aiLight const& source = *from.mLights[i];
            Light light;
            light.name = source.mName.C_Str();
            if (source.mType != aiLightSource_DIRECTIONAL && source.mType != aiLightSource_POINT &&
                source.mType != aiLightSource_SPOT) {
                scene.warnings.push_back("light '" + light.name +
                                         "' is neither directional, point nor spot; passed over");
                continue;
            }
            light.type = source.mType == aiLightSource_DIRECTIONAL ? LightType::directional
                         : source.mType == aiLightSource_SPOT      ? LightType::spot
                                                                   : LightType::point;
            Vec3 const back = unit_or(-to_vec3(source.mDirection), Vec3(0, 0, 1));
            Vec3 const right = any_perpendicular(back);
            light.node = add_node(light.name, find(source.mName), placed(right, back, source.mPosition));
            Vec3 const color(source.mColorDiffuse.r, source.mColorDiffuse.g, source.mColorDiffuse.b);
            float const strength = std::max({color.x, color.y, color.z});
            light.color = strength > 0 ? color / strength : Vec3(1);
            // 1 / (quadratic * d^2) falls off as glTF's candela do; other attenuations have no counterpart.
            bool const quadratic = light.type != LightType::directional && source.mAttenuationQuadratic > 0;
            light.intensity = quadratic ? strength / source.mAttenuationQuadratic : strength;
            light.outer_cone = 0.5f * source.mAngleOuterCone;
            light.inner_cone = 0.5f * source.mAngleInnerCone;
            scene.lights.push_back(light);
        }
    }

    void add_clips() {
        for (unsigned a = 0; a < from.mNumAnimations; ++a) {
            aiAnimation const& source = *from.mAnimations[a];
            double const ticks_per_second = source.mTicksPerSecond > 0 ? source.mTicksPerSecond : 25;
            AnimationClip clip;
            clip.name = *source.mName.C_Str() ? source.mName.C_Str() : "clip " + std::to_string(a + 1);
            for (unsigned c = 0; c < source.mNumChannels; ++c) {
                aiNodeAnim const& keys = *source.mChannels[c];
                Index const node = find(keys.mNodeName);
                if (node == none) {
                    scene.warnings.push_back("animation '" + clip.name + "' moves '" + keys.mNodeName.C_Str() +
                                             "', which is missing; passed over");
                    continue;
                }
                auto const add = [&](AnimatedProperty property, int components, unsigned count, auto const* from_keys,
                                     auto const& value_of) {
                    AnimationChannel channel{node, property, Interpolation::linear, components, {}, {}};
                    for (unsigned k = 0; k < count; ++k) {
                        channel.times.push_back(static_cast<float>(from_keys[k].mTime / ticks_per_second));
                        Vec4 const value = value_of(from_keys[k].mValue);
                        for (int i = 0; i < components; ++i) {
                            channel.values.push_back(value[i]);
                        }
                    }
                    if (count > 0) {
                        clip.channels.push_back(std::move(channel));
                    }
                };
                auto const vector = [](aiVector3D const& v) { return Vec4(v.x, v.y, v.z, 0); };
                add(AnimatedProperty::translation, 3, keys.mNumPositionKeys, keys.mPositionKeys, vector);
                add(AnimatedProperty::rotation, 4, keys.mNumRotationKeys, keys.mRotationKeys,
                    [](aiQuaternion const& q) { return Vec4(q.x, q.y, q.z, q.w); });
                add(AnimatedProperty::scale, 3, keys.mNumScalingKeys, keys.mScalingKeys, vector);
            }
            if (source.mNumMorphMeshChannels + source.mNumMeshChannels > 0) {
                scene.warnings.push_back("animation '" + clip.name + "' also changes shapes; that is passed over");
            }
            scene.clips.push_back(std::move(clip));
        }
    }
};

} // namespace

void import_assimp_nodes(aiScene const& from, ImportBudget& budget, Scene& scene) {
    Builder builder{from, budget, scene, {}, {}};
    builder.add_nodes();
    builder.add_skins();
    builder.add_cameras();
    builder.add_lights();
    builder.add_clips();
}

} // namespace framelet
