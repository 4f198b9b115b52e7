// Decodes what extensions of glTF compress: buffer views by meshoptimizer, meshes by Draco.
// In: compressed bytes. Out: bytes or attributes as if they had not been compressed, or an InputError.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "server/scene/gltf/gltf_file.h"
#include "server/scene/reading/import_budget.h"

namespace framelet {

/// Decodes the buffer views that EXT_meshopt_compression has compressed into `file.decoded_views`. Those that are
/// broken are named in `faults`, and stay as they are.
void decompress_views(GltfFile& file, ImportBudget& budget, std::vector<std::string>& faults);

/// A mesh of KHR_draco_mesh_compression.
class DracoMesh {
public:
    /// `ids`: numbers of its attributes by the names that glTF has for them.
    DracoMesh(std::span<std::byte const> bytes, Json const& ids);
    ~DracoMesh();
    DracoMesh(DracoMesh&&) noexcept;
    DracoMesh& operator=(DracoMesh&&) = delete;

    std::size_t vertex_count() const;
    /// True where it should have that attribute; reading one that it has not throws.
    bool has(std::string const& name) const;
    std::size_t components(std::string const& name) const;

    /// All elements, of `components` floats each. Integers become -1..1 or 0..1 where they are `normalized`.
    void read(std::string const& name, bool normalized, std::size_t components, float* out) const;
    std::vector<std::uint32_t> read_integers(std::string const& name, std::size_t components) const;
    /// Three a triangle.
    std::vector<std::uint32_t> indices() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace framelet
