// Reads glTF accessors as typed values: strided, sparse, normalised integers. Every index, offset and count of the file
// is checked here before it is used. In: a file. Out: vectors of values, or an InputError.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/math.h"
#include "server/scene/gltf/gltf_file.h"
#include "server/scene/reading/import_budget.h"

namespace framelet {

class GltfAccessors {
public:
    GltfAccessors(GltfFile const& file, ImportBudget& budget) : file_(file), budget_(budget) {}

    /// The bytes of a buffer view, decoded; throws where there is no such view, or the file does not hold all of it.
    std::span<std::byte const> view(Index buffer_view) const;

    /// Number of elements; throws where there is no such accessor, or the file does not hold so many.
    std::size_t count(Index accessor) const;
    /// False where all elements are zero, but for those that a sparse accessor replaces.
    bool has_view(Index accessor) const;
    /// Whether integers stand for fractions.
    bool is_normalized(Index accessor) const;
    /// Components of an element: 1 to 4, 9, 16.
    std::size_t components(Index accessor) const;

    /// All elements; T is float, Vec2, Vec3, Vec4 or Mat4 and must have as many components as the accessor. Integers
    /// become -1..1 or 0..1 where the accessor says `normalized`, else keep their value.
    template <class T>
    std::vector<T> read(Index accessor) const {
        constexpr std::size_t component_bytes = sizeof(float);
        std::vector<T> values(checked_count(accessor, sizeof(T) / component_bytes, sizeof(T)));
        if (!values.empty()) {
            read_floats(accessor, reinterpret_cast<float*>(values.data()));
        }
        return values;
    }

    ImportBudget& budget() const { return budget_; }

    /// All components of all elements as they are stored; the accessor must have `components` unsigned integers.
    std::vector<std::uint32_t> read_integers(Index accessor, std::size_t components) const;

private:
    struct Accessor;
    Accessor find(Index accessor) const;
    std::size_t checked_count(Index accessor, std::size_t components, std::size_t bytes_each) const;
    void read_floats(Index accessor, float* out) const;
    template <class Visit>
    void for_each_element(Accessor const& accessor, Visit const& visit) const;

    GltfFile const& file_;
    ImportBudget& budget_;
};

/// An accessor that says nothing of its values (all are zero, or sparse) is taken for broken when it has more of them.
inline constexpr std::uint64_t max_zero_elements = std::uint64_t(1) << 24;

} // namespace framelet
