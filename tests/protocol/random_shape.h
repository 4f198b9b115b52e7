// Random well-formed shapes for property tests. In: a seeded generator. Out: shapes with every number of layers,
// outliers or none, magnitudes over many decades.
#pragma once

#include <cmath>
#include <random>

#include "common/framelet/framelet_shape.h"

namespace framelet {

class RandomShapes {
public:
    explicit RandomShapes(std::uint64_t seed) : generator_(seed) {}

    std::uint32_t integer(std::uint32_t lowest, std::uint32_t highest) {
        return std::uniform_int_distribution<std::uint32_t>(lowest, highest)(generator_);
    }
    float number(float lowest, float highest) {
        return integer(0, 7) == 0 ? 0 : std::uniform_real_distribution<float>(lowest, highest)(generator_);
    }
    BodyNumber body() { return static_cast<BodyNumber>(integer(0, 2) == 0 ? integer(0, 65535) : integer(0, 2)); }
    Vec3 vector(float scale) { return {scale * number(-90, 90), scale * number(-9, 9), scale * number(-0.5f, 0.5f)}; }
    SwingCode swing() { return static_cast<SwingCode>(integer(0, 1) == 0 ? 0 : integer(0, 255)); }
    Drift drift(bool deforms) {
        return deforms ? Drift{vector(1), vector(5), std::max(number(-10, 2000), 0.0f), swing()} : Drift{};
    }
    LayerDrift layer_drift(bool deforms) {
        return deforms ? LayerDrift{drift(true), vector(0.1f), vector(0.01f), vector(0.3f), vector(0.1f)}
                       : LayerDrift{};
    }

    FrameletShape shape(bool deforms) {
        FrameletShape shape;
        shape.layer_count = static_cast<std::uint8_t>(integer(0, max_layers));
        shape.decorrelation = static_cast<DecorrelationCode>(integer(0, 255));
        float const scale = std::exp(number(-20, 12));
        for (std::size_t l = 0; l < shape.layer_count; ++l) {
            shape.layers[l] = {scale * number(-1, 1),
                               scale * number(-0.1f, 0.1f),
                               scale * number(-0.1f, 0.1f),
                               scale * number(0, 1e-3f),
                               body(),
                               layer_drift(deforms)};
        }
        bool const has_outliers = shape.layer_count == 0 || integer(0, 1) == 1;
        std::uint32_t const kinds = shape.layer_count + (has_outliers ? 1u : 0u);
        std::uint32_t kind = 0;
        for (std::uint8_t& layer : shape.layer_of) {
            kind = integer(0, 5) == 0 ? integer(0, kinds - 1) : kind;
            layer = kind < shape.layer_count ? static_cast<std::uint8_t>(kind) : FrameletShape::outlier;
            if (layer == FrameletShape::outlier) {
                shape.outliers.push_back({scale * number(0, 1), body(), drift(deforms)});
            }
        }
        return shape;
    }

private:
    std::mt19937_64 generator_;
};

} // namespace framelet
