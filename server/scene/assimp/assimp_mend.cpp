#include "server/scene/assimp/assimp_mend.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <string>

#include <assimp/scene.h>

#include "server/scene/vector_math.h"

namespace framelet {
namespace {

bool is_usable(aiVector3D const& normal) {
    Vec3 const v(normal.x, normal.y, normal.z);
    return is_finite(v) && unit_or(v, Vec3(0)) != Vec3(0);
}

/// Replaces the array by its elements at `from`.
template <class T>
void gather(T*& values, std::vector<unsigned> const& from) {
    if (values) {
        T* const gathered = new T[from.size()]; // the mesh owns and deletes them
        std::transform(from.begin(), from.end(), gathered, [values](unsigned i) { return values[i]; });
        delete[] values;
        values = gathered;
    }
}

/// As `gather`, of all that a vertex of an aiMesh or aiAnimMesh has.
template <class T>
void gather_vertices(T& mesh, std::vector<unsigned> const& from) {
    for (aiVector3D** const values : {&mesh.mVertices, &mesh.mNormals, &mesh.mTangents, &mesh.mBitangents}) {
        gather(*values, from);
    }
    for (aiVector3D*& uv : mesh.mTextureCoords) {
        gather(uv, from);
    }
    for (aiColor4D*& colors : mesh.mColors) {
        gather(colors, from);
    }
    mesh.mNumVertices = static_cast<unsigned>(from.size());
}

/// Makes the bone hold each of the vertices that have come of those that it held: `first_of[v]` to `first_of[v + 1]`
/// of `copies`.
void gather_weights(aiBone& bone, std::vector<unsigned> const& first_of, std::vector<unsigned> const& copies) {
    std::vector<aiVertexWeight> weights;
    for (unsigned w = 0; w < bone.mNumWeights; ++w) {
        aiVertexWeight const& weight = bone.mWeights[w];
        if (weight.mVertexId + 1 < first_of.size()) {
            for (unsigned i = first_of[weight.mVertexId]; i < first_of[weight.mVertexId + 1]; ++i) {
                weights.emplace_back(copies[i], weight.mWeight);
            }
        }
    }
    delete[] bone.mWeights;
    bone.mWeights = new aiVertexWeight[weights.size()];
    std::copy(weights.begin(), weights.end(), bone.mWeights);
    bone.mNumWeights = static_cast<unsigned>(weights.size());
}

/// Gives each corner of the polygons a vertex of its own.
void unshare_vertices(aiMesh& mesh) {
    std::vector<unsigned> from; // the vertex of each corner
    std::vector<unsigned> first_of(mesh.mNumVertices + std::size_t(1));
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        for (unsigned k = 0; k < mesh.mFaces[f].mNumIndices; ++k) {
            unsigned& index = mesh.mFaces[f].mIndices[k];
            ++first_of[index + 1];
            from.push_back(index);
            index = static_cast<unsigned>(from.size() - 1);
        }
    }
    std::partial_sum(first_of.begin(), first_of.end(), first_of.begin());
    std::vector<unsigned> copies(from.size());
    std::vector<unsigned> next = first_of;
    for (std::size_t corner = 0; corner < from.size(); ++corner) {
        copies[next[from[corner]]++] = static_cast<unsigned>(corner);
    }
    for (unsigned b = 0; b < mesh.mNumBones; ++b) {
        gather_weights(*mesh.mBones[b], first_of, copies);
    }
    for (unsigned t = 0; t < mesh.mNumAnimMeshes; ++t) {
        if (mesh.mAnimMeshes[t]->mNumVertices == mesh.mNumVertices) {
            gather_vertices(*mesh.mAnimMeshes[t], from);
        }
    }
    gather_vertices(mesh, from);
}

} // namespace

std::vector<aiVector3D> take_normals(aiMesh& mesh) {
    bool const has_all = mesh.mNormals && std::all_of(mesh.mNormals, mesh.mNormals + mesh.mNumVertices, is_usable);
    if (has_all || mesh.mNumFaces == 0) {
        return {};
    }
    unshare_vertices(mesh);
    std::vector<aiVector3D> taken;
    if (mesh.mNormals) {
        taken.assign(mesh.mNormals, mesh.mNormals + mesh.mNumVertices);
        delete[] mesh.mNormals;
        mesh.mNormals = nullptr;
    }
    return taken;
}

void put_back_normals(aiMesh& mesh, std::vector<aiVector3D> const& taken) {
    for (std::size_t i = 0; mesh.mNormals && i < taken.size() && i < mesh.mNumVertices; ++i) {
        if (is_usable(taken[i])) {
            mesh.mNormals[i] = taken[i];
        }
    }
}

void place_by_settings(aiScene const& scene) {
    aiMetadata const* const settings = scene.mMetaData;
    float centimetres = 1; // a unit is
    if (!settings || !settings->Get("UnitScaleFactor", centimetres) || !(centimetres > 0)) {
        return;
    }
    ai_real const scale = 0.01f * centimetres;
    aiMatrix4x4 placed;
    placed.d4 = 1;
    bool is_used[3] = {};
    char const* const names[3] = {"CoordAxis", "UpAxis", "FrontAxis"}; // become x, y and z
    for (unsigned row = 0; row < 3; ++row) {
        std::int32_t axis = static_cast<std::int32_t>(row);
        std::int32_t sign = 1;
        settings->Get(names[row], axis);
        settings->Get(std::string(names[row]) + "Sign", sign);
        if (axis < 0 || axis > 2 || is_used[axis]) {
            return;
        }
        is_used[axis] = true;
        for (unsigned column = 0; column < 3; ++column) {
            placed[row][column] = column == static_cast<unsigned>(axis) ? scale * (sign < 0 ? -1 : 1) : 0;
        }
    }
    scene.mRootNode->mTransformation = placed * scene.mRootNode->mTransformation;
}

} // namespace framelet
