#include "server/scene/assimp/assimp_import.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <sstream>
#include <utility>

#include <assimp/DefaultIOStream.h>
#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/ProgressHandler.hpp>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "common/color.h"
#include "common/counted.h"
#include "common/error.h"
#include "server/scene/assimp/assimp_log.h"
#include "server/scene/assimp/assimp_mend.h"
#include "server/scene/assimp/assimp_parts.h"
#include "server/scene/assimp/mesh_header.h"
#include "server/scene/assimp/polygon.h"
#include "server/scene/finish/finish_parts.h"
#include "server/scene/reading/held_exception.h"
#include "server/scene/reading/memory_limit.h"

namespace framelet {
namespace {

/// Bytes of memory that a byte of a mesh file becomes, roughly: six for an OBJ, more for a binary PLY. A file that
/// cannot fit is thus refused before it is read.
constexpr std::uint64_t memory_per_file_byte = 8;

/// Normals of a file without any are smooth across edges up to this angle.
constexpr float crease_degrees = 66;

/// A file that is open, as Assimp reads it.
class OpenedStream : public Assimp::DefaultIOStream {
public:
    explicit OpenedStream(RegularFile file)
        : DefaultIOStream(std::fopen(file.name().c_str(), "rb"), file.name()), file_(std::move(file)) {}

private:
    RegularFile file_; ///< whose name is asked for its size
};

/// Opens the scene file and what the folder permits. Notes which files could not be opened: Assimp only mentions them
/// in its log.
class PermittedFiles : public Assimp::DefaultIOSystem {
public:
    PermittedFiles(std::string scene_file, SceneFolder const& folder, std::vector<std::string>& missing)
        : scene_file_(std::move(scene_file)), folder_(folder), missing_(missing) {}

    bool Exists(char const* file) const override { return open(file).has_value(); }

    Assimp::IOStream* Open(char const* file, char const*) override {
        std::optional<RegularFile> opened = open(file);
        if (!opened) {
            missing_.emplace_back(file);
        }
        return opened ? new OpenedStream(std::move(*opened)) : nullptr;
    }

private:
    std::optional<RegularFile> open(char const* file) const {
        if (file == scene_file_) {
            RegularFile opened(file);
            return opened ? std::optional(std::move(opened)) : std::nullopt;
        }
        return folder_.permits(file) ? folder_.open(file) : std::nullopt;
    }

    std::string scene_file_;
    SceneFolder const& folder_;
    std::vector<std::string>& missing_;
};

/// Hands on how far Assimp is. Where that throws, Assimp is told to stop; not all of its readers look at that.
class ReadingProgress : public Assimp::ProgressHandler {
public:
    ReadingProgress(Progress const& progress, HeldException& held) : progress_(progress), held_(held) {}

    bool Update(float) override {
        return held_.call([] {});
    }
    void UpdateFileRead(int byte, int bytes) override {
        if (bytes > 0) { // it counts in 32 bits: of a file of 2 GiB nothing is said
            held_.call([&] { progress_("reading", static_cast<double>(byte) / bytes); });
        }
    }

private:
    Progress const& progress_;
    HeldException& held_;
};

Vec3 to_vec3(aiVector3D const& v) {
    return {v.x, v.y, v.z};
}

/// Faces that are no surfaces.
struct LeftOut {
    std::size_t points = 0;
    std::size_t lines = 0;
    std::size_t broken = 0; ///< with corners that are no numbers
};

/// Drops polygons with corners that are no numbers, and counts them: smoothing would spread these.
void drop_broken_faces(aiMesh& mesh, LeftOut& left_out) {
    unsigned kept = 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        aiFace& face = mesh.mFaces[f];
        bool const is_whole = std::all_of(face.mIndices, face.mIndices + face.mNumIndices,
                                          [&](unsigned i) { return in_range(to_vec3(mesh.mVertices[i])); });
        if (is_whole) {
            std::swap(mesh.mFaces[kept].mNumIndices, face.mNumIndices);
            std::swap(mesh.mFaces[kept].mIndices, face.mIndices);
            ++kept;
        }
    }
    left_out.broken += mesh.mNumFaces - kept;
    mesh.mNumFaces = kept;
}

/// Replaces polygons by triangles; drops points and lines, and counts them. Assimp's own step
/// leaves holes in polygons that cross themselves (24 triangles of 116,501 in one model tried).
void triangulate_faces(aiMesh& mesh, LeftOut& left_out) {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<Vec3> corners;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
        aiFace const& face = mesh.mFaces[f];
        left_out.points += face.mNumIndices == 1;
        left_out.lines += face.mNumIndices == 2;
        corners.clear();
        for (unsigned i = 0; i < face.mNumIndices; ++i) {
            corners.push_back(to_vec3(mesh.mVertices[face.mIndices[i]]));
        }
        for (auto const& [a, b, c] : triangulate(corners)) {
            triangles.push_back({face.mIndices[a], face.mIndices[b], face.mIndices[c]});
        }
    }
    delete[] mesh.mFaces;
    mesh.mFaces = new aiFace[triangles.size()]; // the mesh owns and deletes them
    mesh.mNumFaces = static_cast<unsigned>(triangles.size());
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        mesh.mFaces[i].mNumIndices = 3;
        mesh.mFaces[i].mIndices = new unsigned[3]{triangles[i][0], triangles[i][1], triangles[i][2]};
    }
    mesh.mPrimitiveTypes = aiPrimitiveType_TRIANGLE;
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
            primitive.uv[set].emplace_back(uv.x, 1 - uv.y); // Assimp's v goes upwards
        }
    }
    for (std::size_t i = 0; from.mColors[0] && i < count; ++i) {
        aiColor4D const& color = from.mColors[0][i]; // as it is displayed, in these formats
        primitive.colors.emplace_back(linear_from_srgb(color.r), linear_from_srgb(color.g), linear_from_srgb(color.b),
                                      color.a);
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
        unsigned const* const index = from.mFaces[f].mIndices;
        primitive.triangles.push_back({index[0], index[1], index[2]});
    }
    return primitive;
}

Scene import_assimp(std::filesystem::path const& file, SceneFolder const& folder, ImportBudget& budget,
                    Progress const& progress, bool is_checked) {
    Scene scene;
    std::vector<std::string> missing;
    LeftOut left_out;
    progress("reading", 0);
    AssimpLog const log;
    Assimp::Importer importer;
    std::string const extension = file.extension().string();
    if (extension.empty() || !importer.IsExtensionSupported(extension)) {
        throw InputError("the format '" + extension + "' is not known; .gltf, .glb and .obj always work");
    }
    check_mesh_header(file);
    ImportBudget(budget).reserve(std::filesystem::file_size(file), memory_per_file_byte);
    HeldException held;
    importer.SetIOHandler(new PermittedFiles(file.string(), folder, missing)); // owned by the importer
    importer.SetProgressHandler(new ReadingProgress(progress, held)); // as well
    importer.SetPropertyFloat(AI_CONFIG_PP_GSN_MAX_SMOOTHING_ANGLE, crease_degrees);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    aiScene const* from = nullptr;
    try {
        std::optional<MemoryLimit> limit;
        if (!is_checked) {
            limit.emplace(budget.left()); // Assimp takes memory without asking
        }
        from = importer.ReadFile(file.string(), aiProcess_ValidateDataStructure);
        std::vector<std::vector<aiVector3D>> normals; // those of each mesh that are kept beside new ones
        if (from && held.call([&] { progress("triangulating", 0); })) {
            for (unsigned m = 0; m < from->mNumMeshes; ++m) {
                drop_broken_faces(*from->mMeshes[m], left_out);
                normals.push_back(take_normals(*from->mMeshes[m]));
                triangulate_faces(*from->mMeshes[m], left_out);
                held.call([&] { progress("triangulating", (m + 1.0) / from->mNumMeshes); });
            }
        }
        // Of how far it is in one of these Assimp says nothing.
        if (from && held.call([&] { progress("smoothing normals", 0); })) {
            from = importer.ApplyPostProcessing(aiProcess_GenSmoothNormals);
            for (unsigned m = 0; from && m < from->mNumMeshes; ++m) {
                put_back_normals(*from->mMeshes[m], normals[m]);
            }
        }
        if (from && held.call([&] { progress("joining vertices", 0); })) {
            from = importer.ApplyPostProcessing(aiProcess_JoinIdenticalVertices);
            held.call([&] { progress("joining vertices", 1); });
        }
    } catch (std::bad_alloc const&) {
        throw budget.too_large();
    } catch (std::exception const& error) {
        throw InputError(error.what());
    }
    held.rethrow();
    if (!from || !from->mRootNode) {
        std::string const why = importer.GetErrorString();
        if (why.find("bad_alloc") != std::string::npos || why.find("bad_array_new_length") != std::string::npos) {
            throw budget.too_large();
        }
        if (why.find("contains no faces") != std::string::npos || why.find("mNumMeshes is 0") != std::string::npos) {
            throw InputError("it has no surfaces, and only these are shown");
        }
        if (why.find("No suitable reader") != std::string::npos) {
            throw InputError("what is in it is not " + extension);
        }
        throw InputError(why.empty() ? "it has no content" : "Assimp cannot read it: " + why);
    }
    for (std::string const& name : missing) {
        std::string const problem =
            folder.permits(name) ? "file '" + name + "' is missing" : SceneFolder::refusal("file", name);
        scene.warnings.push_back(problem + "; shown without it");
    }
    for (auto const& [count, what] : {std::pair(left_out.points, "point"), std::pair(left_out.lines, "line")}) {
        if (count > 0) {
            scene.warnings.push_back(counted(count, what) + (count == 1 ? " is" : " are") +
                                     " not shown: only surfaces are");
        }
    }
    if (left_out.broken > 0) {
        scene.warnings.push_back(counted(left_out.broken, "polygon") + " left out for corners that are not numbers");
    }
    for (std::string& loss : log.losses()) {
        scene.warnings.push_back(std::move(loss));
    }
    place_by_settings(*from);
    import_assimp_materials(*from, folder, budget, scene, progress);
    import_assimp_nodes(*from, budget, scene);
    return scene;
}

std::set<std::string> assimp_endings() {
    aiString list; // "*.3ds;*.obj"
    Assimp::Importer().GetExtensionList(list);
    std::istringstream words(list.C_Str());
    std::set<std::string> endings;
    for (std::string word; std::getline(words, word, ';');) {
        endings.insert(word.substr(word.find('*') + 1));
    }
    return endings;
}

} // namespace framelet
