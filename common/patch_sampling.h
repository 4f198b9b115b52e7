// The samples of a layer at a few pixels of a row: bilinear interpolation between those that lie on the layer. In: a
// patch, places in the picture. Out: weighted sums that compete for the pixels.
#pragma once

#include <array>
#include <cstdint>

#include "common/warp_patch.h"

namespace framelet {

/// Pixels of a row that are worked on together: half a block.
inline constexpr int sampling_lanes = FrameletCache::block_side / 2;

/// What a patch or a splat shows at each of them: sums of weights and weighted sums of squares of bytes.
struct Candidate {
    template <class T>
    using Lanes = std::array<T, static_cast<std::size_t>(sampling_lanes)>;

    alignas(64) Lanes<float> red, green, blue, weight, inverse_depth;
};

/// The square of a byte, which stands for linear light.
inline float square(std::uint32_t byte) {
    auto const value = static_cast<float>(static_cast<std::int32_t>(byte));
    return value * value;
}

/// Samples one patch after the other. Weights and squares have 15 bits: 8 of 255^2, bytes come back exactly.
class PatchSampler {
public:
    /// Gets ready for the pixels of `area`, whose sides are multiples of `sampling_lanes` in x. The patch must outlive
    /// the calls of `sample`. False: it shows nothing there.
    bool turn_to(WarpPatch const& patch, PixelRect const& area);
    /// At pixels of the area of which (x, y) is the first; those outside of the patch's box get no weight.
    void sample(int x, int y, Candidate& out) const;

private:
    static constexpr std::size_t planes = 4; ///< squares of red, green, blue; whether the sample lies on the layer
    static constexpr std::size_t row_stride = 24; ///< column -1 comes first; it and those from `side` on are 0

    void convert_rows();
    void convert_row(PackedSample const* from, std::int16_t* to) const;
    /// Column -1 of a row that is converted.
    std::int16_t const* row(std::int32_t v, std::size_t plane) const {
        return &rows_[(static_cast<std::size_t>(v + 1) * planes + plane) * row_stride];
    }
    bool sample_together(float u, float v, float z, Candidate& out) const;
    void sample_singly(float u, float v, float z, Candidate& out) const;

    WarpPatch const* patch_ = nullptr;
    bool is_in_front_ = false; ///< everywhere in the area
    std::int32_t first_row_ = 0, last_row_ = 0; ///< that are converted, from -1 to `side`
    /// A few values may be read past the last row.
    alignas(64) std::array<std::int16_t, (framelet_side + 2) * planes * row_stride + 8> rows_{};
};

} // namespace framelet
