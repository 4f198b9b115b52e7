#include "server/scene/assimp_import.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "common/error.h"
#include "server/scene/assimp_parts.h"

namespace framelet {
namespace {

/// Normals of a file without any are smooth across edges up to this angle.
constexpr float crease_degrees = 66;

/// Notes which files could not be opened: Assimp only mentions them in its log.
class NotingFiles : public Assimp::DefaultIOSystem {
public:
    explicit NotingFiles(std::vector<std::string>& missing) : missing_(missing) {}

    Assimp::IOStream* Open(char const* file, char const* mode) override {
        Assimp::IOStream* const stream = DefaultIOSystem::Open(file, mode);
        if (!stream) {
            missing_.emplace_back(file);
        }
        return stream;
    }

private:
    std::vector<std::string>& missing_;
};

Vec3 to_vec3(aiVector3D const& v) {
    return {v.x, v.y, v.z};
}

} // namespace

Primitive import_assimp_primitive(aiMesh const& from) {
    Primitive primitive;
    primitive.material = static_cast<Index>(from.mMaterialIndex);
    std::size_t const count = from.mNumVertices;
    auto const vectors = [count](aiVector3D const* values) {
        std::vector<Vec3> result;
        for (std::size_t i = 0; values && i < count; ++i) {
            result.push_back(to_vec3(values[i]));
        }
        return result;
    };
    primitive.positions = vectors(from.mVertices);
    primitive.normals = vectors(from.mNormals);
    for (std::size_t set = 0; set < 2; ++set) {
        for (Vec3 const& uv : vectors(from.mTextureCoords[set])) {
            primitive.uv[set].emplace_back(uv);
        }
    }
    for (std::size_t i = 0; from.mColors[0] && i < count; ++i) {
        aiColor4D const& color = from.mColors[0][i];
        primitive.colors.emplace_back(color.r, color.g, color.b, color.a);
    }
    for (unsigned t = 0; t < from.mNumAnimMeshes; ++t) {
        aiAnimMesh const& shape = *from.mAnimMeshes[t]; // whole positions, not offsets
        MorphTarget target;
        if (shape.mNumVertices == from.mNumVertices) {
            target.positions = vectors(shape.mVertices);
            target.normals = primitive.normals.empty() ? std::vector<Vec3>() : vectors(shape.mNormals);
        }
        for (std::size_t i = 0; i < target.positions.size(); ++i) {
            target.positions[i] -= primitive.positions[i];
        }
        for (std::size_t i = 0; i < target.normals.size(); ++i) {
            target.normals[i] -= primitive.normals[i];
        }
        primitive.morph_targets.push_back(std::move(target));
    }
    for (unsigned f = 0; f < from.mNumFaces; ++f) {
        aiFace const& face = from.mFaces[f];
        if (face.mNumIndices == 3) {
            primitive.triangles.push_back({face.mIndices[0], face.mIndices[1], face.mIndices[2]});
        }
    }
    return primitive;
}

Scene import_assimp(std::filesystem::path const& file, Progress const& progress) {
    Scene scene;
    std::vector<std::string> missing;
    progress("reading", 0);
    Assimp::Importer importer;
    std::string const extension = file.extension().string();
    if (extension.empty() || !importer.IsExtensionSupported(extension)) {
        throw InputError("the format '" + extension + "' is not known; .gltf, .glb and .obj always work");
    }
    importer.SetIOHandler(new NotingFiles(missing)); // owned by the importer
    importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, crease_degrees);
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    aiScene const* from = nullptr;
    try {
        from = importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_SortByPType |
                                                    aiProcess_GenSmoothNormals | aiProcess_JoinIdenticalVertices |
                                                    aiProcess_FlipUVs | aiProcess_TransformUVCoords |
                                                    aiProcess_ValidateDataStructure);
    } catch (std::exception const& error) {
        throw InputError(error.what());
    }
    if (!from || !from->mRootNode) {
        std::string const why = importer.GetErrorString();
        throw InputError(why.empty() ? "it has no content" : why);
    }
    for (std::string const& name : missing) {
        scene.warnings.push_back("file '" + name + "' is missing; shown without it");
    }
    progress("reading", 1);
    import_assimp_materials(*from, file.parent_path(), scene, progress);
    import_assimp_nodes(*from, scene);
    return scene;
}

} // namespace framelet
