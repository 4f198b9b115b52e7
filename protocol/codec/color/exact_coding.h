// Codes samples without loss as decisions of a range coder: their differences from a prediction or from their
// neighbours, those of red and blue less those of green. In: samples. Out: decisions, and back.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>

#include "common/framelet/framelet.h"
#include "protocol/codec/entropy/adaptive_numbers.h"
#include "protocol/codec/entropy/morton_rows.h"

namespace framelet {

class ExactModel {
public:
    /// Codes the samples of `framelet`, which are filled where the coder reads. `predicted`: what they are predicted
    /// by; null: each sample is predicted by its neighbours (the median edge detector of [Weinberger 2000]).
    template <class Coder>
    void code(Coder& coder, DisplayFramelet const* predicted, DisplayFramelet& framelet) {
        Plane green_left{}, left;
        code_plane(coder, 0, predicted, &DisplayFramelet::green, Plane{}, framelet, green_left);
        code_plane(coder, 1, predicted, &DisplayFramelet::red, green_left, framelet, left);
        code_plane(coder, 1, predicted, &DisplayFramelet::blue, green_left, framelet, left);
    }

private:
    /// Residuals of a plane in rows, with a row of zeros above them and a column of zeros to the left.
    struct Plane {
        static constexpr std::size_t stride = framelet_side + 1;
        std::array<std::int16_t, stride * stride> values{};

        std::int16_t& at(std::size_t x, std::size_t y) { return values[(y + 1) * stride + x + 1]; }
        std::int16_t at(std::size_t x, std::size_t y) const { return values[(y + 1) * stride + x + 1]; }
    };
    static constexpr std::size_t size_classes = 7;

    static std::size_t class_of(int size) {
        return std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(static_cast<unsigned>(size))),
                                     size_classes - 1);
    }
    static int median_of_edges(int left, int above, int corner) {
        return std::clamp(left + above - corner, std::min(left, above), std::max(left, above));
    }

    /// Codes one plane; `kind` is 0 for green, 1 for red and blue. `left` becomes the coded residuals: each sample less
    /// its prediction, less `green_left` there.
    template <class Coder>
    void code_plane(Coder& coder, std::size_t kind, DisplayFramelet const* predicted,
                    SamplePlane DisplayFramelet::*plane, Plane const& green_left, DisplayFramelet& framelet,
                    Plane& left) {
        left = {};
        SamplePlane rows{}, foretold{};
        if (!Coder::reads) {
            to_rows((framelet.*plane).data(), rows.data(), framelet_side);
        }
        if (predicted != nullptr) {
            to_rows((predicted->*plane).data(), foretold.data(), framelet_side);
        }
        auto& models = sizes_[predicted != nullptr ? 1 : 0][kind];
        for (std::size_t y = 0; y < framelet_side; ++y) {
            for (std::size_t x = 0; x < framelet_side; ++x) {
                std::size_t const i = y * framelet_side + x;
                int const from =
                    predicted != nullptr ? foretold[i]
                    : y == 0             ? (x == 0 ? 128 : rows[i - 1])
                    : x == 0             ? rows[i - framelet_side]
                             : median_of_edges(rows[i - 1], rows[i - framelet_side], rows[i - framelet_side - 1]);
                auto const own = static_cast<std::int8_t>(rows[i] - from);
                auto const beside = static_cast<std::int8_t>(own - green_left.at(x, y));
                int const around = std::abs(int{left.at(x - 1, y)}) + std::abs(int{left.at(x, y - 1)});
                auto const coded = static_cast<std::int8_t>(models[class_of(around)].code(coder, std::int16_t{beside}));
                left.at(x, y) = std::int16_t{coded};
                if (Coder::reads) {
                    rows[i] = static_cast<std::uint8_t>(from + coded + green_left.at(x, y));
                }
            }
        }
        if (Coder::reads) {
            from_rows(rows.data(), framelet_side, (framelet.*plane).data());
        }
    }

    std::array<std::array<std::array<AdaptiveNumber<6>, size_classes>, 2>, 2> sizes_; // if predicted; kind; class
};

} // namespace framelet
