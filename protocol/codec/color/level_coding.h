// Codes quantised Haar details as decisions of a range coder: each level by how large its neighbours are, the coarser
// one that covers it, and those of the other planes there (as [Shapiro 1993] and [Taubman 2000] do). In: levels. Out:
// decisions, and back.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "common/morton.h"
#include "protocol/codec/color/haar_planes.h"
#include "protocol/codec/entropy/adaptive_numbers.h"

namespace framelet {

/// Model of levels: how likely each decision is, as the levels that were coded before have taught.
class LevelModel {
public:
    /// Codes the levels of a framelet, which are filled where the coder reads. `is_predicted`: they are of the residual
    /// beside a prediction.
    template <class Coder>
    void code(Coder& coder, bool is_predicted, HaarLevels& levels) {
        std::array<Sizes, 3> sizes{};
        for (std::size_t plane = 0; plane < sizes.size(); ++plane) {
            levels.means[plane] = means_[is_predicted ? 1 : 0][plane].code(coder, levels.means[plane]);
        }
        for (std::size_t plane = 0; plane < sizes.size(); ++plane) {
            if (plane > 0) {
                std::int8_t& share = levels.shares[plane - 1];
                bool const may_share = sizes[0].any();
                auto const code = may_share ? shares_[plane - 1].code(coder, static_cast<unsigned>(share) & 15) : 0u;
                share = static_cast<std::int8_t>(code < 8 ? static_cast<int>(code) : static_cast<int>(code) - 16);
            }
            code_plane(coder, plane, sizes, levels.details[plane]);
        }
    }

private:
    /// Magnitudes of the levels of one plane, `most` at most, in rows with a rim of 0.
    struct Sizes {
        static constexpr std::size_t stride = 10, cells = 9 * stride;
        std::array<std::array<std::array<std::uint8_t, cells>, 3>, haar_octaves> bands;
        std::array<bool, haar_octaves> is_coded;

        bool any() const { return std::ranges::find(is_coded, true) != is_coded.end(); }
    };
    static constexpr int most = 15;

    static constexpr std::size_t bands = 3, near_classes = 4, classes = 3;
    static constexpr std::size_t contexts = classes * classes * near_classes;
    static constexpr std::size_t class_of(unsigned size) { return std::min(size, 2u); }
    static constexpr std::array<unsigned, 7> size_bounds{0, 2, 4, 7, 11, 18, 30};
    static std::size_t size_class(unsigned sum) {
        return static_cast<std::size_t>(std::ranges::lower_bound(size_bounds, sum) - size_bounds.begin());
    }

    template <class Coder>
    void code_plane(Coder& coder, std::size_t plane, std::array<Sizes, 3>& sizes, PlaneDetails& details) {
        std::size_t const kind = plane == 0 ? 0 : 1;
        bool before = false;
        for (std::size_t octave = haar_octaves; octave-- > 0;) {
            std::int16_t* const levels = &details[octave_first[octave]];
            std::size_t const blocks = haar_blocks(octave);
            bool const luma = plane > 0 && sizes[0].is_coded[octave];
            bool const has_any =
                !Coder::reads && std::any_of(levels, levels + 4 * blocks, [](auto v) { return v != 0; });
            bool const any = coder.bit(coded_[kind][octave][(before ? 1u : 0u) + (luma ? 2u : 0u)], has_any);
            sizes[plane].is_coded[octave] = any;
            before = any;
            if (any) {
                code_octave(coder, plane, octave, sizes, levels);
            }
        }
    }

    /// Contexts of a level: what those around it that were coded before say of it.
    struct Around {
        std::size_t context; ///< for whether it is other than 0
        std::size_t size; ///< for its magnitude
    };
    /// `here`: the largest magnitude in the bands of the block that were coded before this one.
    static Around look_around(std::array<Sizes, 3> const& sizes, std::size_t plane, std::size_t octave,
                              std::size_t band, std::size_t x, std::size_t y, unsigned here) {
        std::size_t const at = (y + 1) * Sizes::stride + x + 1;
        std::size_t const above = at - Sizes::stride;
        auto const& own = sizes[plane].bands[octave][band];
        unsigned const near = 2u * (own[at - 1] + own[above]) + own[above - 1] + own[above + 1];
        bool const is_coarsest = octave + 1 == haar_octaves;
        std::size_t const parent = (y / 2 + 1) * Sizes::stride + x / 2 + 1;
        unsigned const coarser = is_coarsest ? 0u : sizes[plane].bands[octave + 1][band][parent];
        unsigned const luma = sizes[0].bands[octave][band][at];
        unsigned const orange = sizes[1].bands[octave][band][at];
        unsigned const beside = plane == 0 ? here : plane == 1 ? std::max(here / 2, luma) : std::max(orange, luma / 2);
        std::size_t const near_class = near == 0 ? 0 : near <= 2 ? 1 : near <= 5 ? 2 : 3;
        return {(class_of(beside) * classes + class_of(coarser)) * near_classes + near_class,
                size_class(near + 2 * (coarser + beside))};
    }

    template <class Coder>
    void code_octave(Coder& coder, std::size_t plane, std::size_t octave, std::array<Sizes, 3>& sizes,
                     std::int16_t* levels) {
        std::size_t const kind = plane == 0 ? 0 : 1;
        std::size_t const side = std::size_t{8} >> octave;
        for (std::size_t y = 0; y < side; ++y) {
            for (std::size_t x = 0; x < side; ++x) {
                std::int16_t* const block =
                    levels + 4 * morton_index(static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y));
                unsigned here = 0;
                for (std::size_t band = 0; band < bands; ++band) {
                    Around const around = look_around(sizes, plane, octave, band, x, y, here);
                    std::int16_t& level = block[band + 1];
                    if (!coder.bit(is_any_[kind][octave][band][around.context], level != 0)) {
                        continue;
                    }
                    bool const is_negative = coder.even_bit(level < 0);
                    int const size = 1 + static_cast<int>(sizes_[kind][octave][around.size].code(
                                             coder, static_cast<std::uint32_t>(std::abs(int{level})) - 1));
                    level = static_cast<std::int16_t>(is_negative ? -size : size);
                    here = std::max(here, static_cast<unsigned>(std::min(size, most)));
                    sizes[plane].bands[octave][band][(y + 1) * Sizes::stride + x + 1] =
                        static_cast<std::uint8_t>(std::min(size, most));
                }
            }
        }
    }

    /// One model for luma and one for chroma, of each octave.
    template <class Model>
    using ByOctave = std::array<std::array<Model, haar_octaves>, 2>;

    std::array<std::array<AdaptiveNumber<14>, 3>, 2> means_;
    std::array<AdaptiveTree<4>, 2> shares_;
    ByOctave<std::array<AdaptiveBit, 4>> coded_;
    ByOctave<std::array<std::array<AdaptiveBit, contexts>, bands>> is_any_;
    ByOctave<std::array<AdaptiveSize<14>, size_bounds.size() + 1>> sizes_;
};

} // namespace framelet
