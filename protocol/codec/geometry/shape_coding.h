// Codes shapes as decisions of a range coder: planes as differences from one that was coded before, and which layer a
// sample lies on by which its neighbours lie on. In: shapes. Out: decisions, and back. PROTOCOL.md has the order.
#pragma once

#include <array>
#include <cstdint>

#include "common/framelet/framelet_shape.h"
#include "protocol/codec/entropy/adaptive_numbers.h"
#include "protocol/codec/geometry/shape_quantisation.h"

namespace framelet {

/// Position of a tile: its upper left corner, pixels, and its side, 2^side_bits pixels.
struct TilePosition {
    std::int32_t left = 0, top = 0;
    std::int32_t side_bits = 0; ///< 0..31
};

/// A layer that was coded, and the tile that it was coded for.
struct CodedLayer {
    LayerCode code;
    BodyNumber body = static_body;
    TilePosition position;
};

/// The plane of a layer as numbers of another tile, in `unit`, clamped to 16 bits; without an error.
LayerCode continued(CodedLayer const& layer, UnitCode unit, TilePosition const& position);

/// Model of shapes: how likely each decision is, as the shapes that were coded before have taught; the same on both
/// sides.
class ShapeModel {
public:
    /// Writes a shape, each sample of which is on one of its layers or one of its outliers (FRAMELET_CHECK).
    void write(RangeWriter& writer, TilePosition const& position, FrameletShape const& shape);
    /// Reads a shape. ProtocolError where what is read is none.
    void read(RangeReader& reader, TilePosition const& position, FrameletShape& shape);

private:
    static constexpr int unary = 3; // unary part of numbers that may be large
    static constexpr int remembered_bits = 3;
    static constexpr std::size_t remembered = std::size_t{1} << remembered_bits;
    static constexpr std::size_t size_classes = 6;
    static constexpr std::size_t most_kinds = max_layers + 1;

    struct BodyModel {
        AdaptiveBit is_same;
        AdaptiveTree<8> high, low;

        template <class Coder>
        BodyNumber code(Coder& coder, BodyNumber last, BodyNumber body);
    };
    /// Vectors, velocity and acceleration, in units: a sample's drift, then how a layer's changes along its tile's
    /// sides.
    struct DriftCode {
        static constexpr std::size_t of_sample = 6, of_layer = 18;
        std::array<std::int16_t, of_layer> values{};
        JerkCode jerk = 0;
        SwingCode swing = 0;

        bool operator==(DriftCode const&) const = default;
    };
    struct DriftModel {
        AdaptiveBit any, is_brief, is_same;
        AdaptiveTree<8> velocity_unit, acceleration_unit, jerk, swing;
        std::array<AdaptiveNumber<unary>, DriftCode::of_layer> values;
    };

    // The shape and its parts are const where the coder writes, and not where it reads.
    template <class Coder, class Shape>
    void code(Coder& coder, TilePosition const& position, Shape& shape);
    template <class Coder, class AnyLayer>
    void code_layer(Coder& coder, TilePosition const& position, std::size_t number, AnyLayer& layer);
    template <class Coder, class Shape>
    void code_kinds(Coder& coder, unsigned kinds, Shape& shape);
    template <class Coder, class Shape>
    void code_outliers(Coder& coder, Shape& shape);
    template <class Coder, class Shape>
    void code_drifts(Coder& coder, TilePosition const& position, Shape& shape);
    template <class Coder>
    void code_drift(Coder& coder, std::size_t count, DriftCode& last, DriftCode const& own);
    std::size_t nearest(LayerCode const& code, BodyNumber body, TilePosition const& position) const;
    void remember(CodedLayer const& layer);

    std::array<CodedLayer, remembered> layers_{}; ///< the last ones that were coded, the newest first
    std::uint8_t head_ = 0;
    DecorrelationCode decorrelation_ = 0;
    UnitCode outlier_unit_ = 0;

    std::array<AdaptiveTree<3>, 8> heads_; // by the head of the last shape
    AdaptiveBit same_decorrelation_;
    AdaptiveTree<8> decorrelations_;
    std::array<AdaptiveTree<remembered_bits>, max_layers> sources_;
    AdaptiveNumber<unary> units_;
    std::array<AdaptiveNumber<unary>, 3> planes_; ///< at, dx, dy
    AdaptiveSize<12> errors_;
    BodyModel layer_bodies_, outlier_bodies_;
    std::array<std::array<AdaptiveBit, 64>, most_kinds - 1> as_expected_;
    std::array<std::array<AdaptiveTree<2>, most_kinds>, most_kinds - 1> others_;
    AdaptiveNumber<unary> outlier_units_;
    std::array<AdaptiveNumber<4>, size_classes> outlier_depths_;
    DriftModel drifts_;
};

} // namespace framelet
