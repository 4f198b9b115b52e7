#include "protocol/codec/geometry/shape_coding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "common/error.h"
#include "protocol/codec/entropy/morton_rows.h"

namespace framelet {
namespace {

/// Returns value * 2^shift, rounded down and clamped to 16 bits.
std::int16_t scaled(std::int64_t value, int shift) {
    using Limits = std::numeric_limits<std::int16_t>;
    if (value == 0) {
        return 0;
    }
    std::int64_t const large = value < 0 ? Limits::lowest() : Limits::max();
    std::int64_t const out = shift <= 0    ? value >> std::min(-shift, 63)
                             : shift >= 16 ? large
                                           : value * (std::int64_t{1} << shift);
    return static_cast<std::int16_t>(std::clamp<std::int64_t>(out, Limits::lowest(), Limits::max()));
}

std::int16_t difference(std::int16_t a, std::int16_t b) {
    return static_cast<std::int16_t>(a - b);
}
std::int16_t sum(std::int16_t a, std::int16_t b) {
    return static_cast<std::int16_t>(a + b);
}

/// Bits, roughly, that the differences of a plane from the expected one take.
int cost(LayerCode const& code, LayerCode const& expected) {
    auto const bits = [](int off) { return static_cast<int>(std::bit_width(static_cast<unsigned>(std::abs(off)))); };
    return 2 * (bits(code.at - expected.at) + bits(code.dx - expected.dx) + bits(code.dy - expected.dy));
}

UnitCode checked_unit(unsigned unit) {
    if (unit > largest_unit) {
        throw ProtocolError("a shape has an unknown unit");
    }
    return static_cast<UnitCode>(unit);
}

/// Calls `use` for every layer of a shape, then for every outlier.
template <typename Shape, typename Use>
void for_each_carried(Shape& shape, Use const& use) {
    for (std::size_t l = 0; l < shape.layer_count; ++l) {
        use(shape.layers[l]);
    }
    for (auto& sample : shape.outliers) {
        use(sample);
    }
}

/// Calls `use` with each vector of a drift, in the order in which they are coded, whether it is of accelerations, and
/// how many of its units make one along the tile's side.
template <typename AnyDrift, typename Use>
void for_each_vector(AnyDrift& drift, double side, Use const& use) {
    if constexpr (requires { drift.corner; }) {
        use(drift.corner.velocity, false, 1.0);
        use(drift.corner.acceleration, true, 1.0);
        use(drift.velocity_dx, false, side);
        use(drift.velocity_dy, false, side);
        use(drift.acceleration_dx, true, side);
        use(drift.acceleration_dy, true, side);
    } else {
        use(drift.velocity, false, 1.0);
        use(drift.acceleration, true, 1.0);
    }
}

/// The drift whose jerk and swing are those of all samples.
template <typename AnyDrift>
auto& common_in(AnyDrift& drift) {
    if constexpr (requires { drift.corner; }) {
        return drift.corner;
    } else {
        return drift;
    }
}

/// The units of velocities and of accelerations.
struct DriftUnits {
    UnitCode velocity = 0, acceleration = 0;

    UnitCode of(bool is_acceleration) const { return is_acceleration ? acceleration : velocity; }
};

/// The smallest units in which all drifts of the shape fit.
DriftUnits drift_units(FrameletShape const& shape, double side) {
    std::array<double, 2> largest{};
    for_each_carried(shape, [&](auto const& carried) {
        for_each_vector(carried.drift, side, [&](Vec3 const& vector, bool is_acceleration, double scale) {
            for (int axis = 0; axis < 3; ++axis) {
                double& most = largest[is_acceleration ? 1 : 0];
                most = std::max(most, scale * std::abs(static_cast<double>(vector[axis])));
            }
        });
    });
    return {unit_above(largest[0] / largest_drift_code), unit_above(largest[1] / largest_drift_code)};
}

UnitCode outlier_unit(FrameletShape const& shape) {
    float largest = 0;
    for (Outlier const& sample : shape.outliers) {
        FRAMELET_CHECK(sample.inverse_depth >= 0);
        largest = std::max(largest, sample.inverse_depth);
    }
    return unit_above(static_cast<double>(largest) / largest_inverse_depth_code);
}

/// Marks samples of a kind beyond the layers as outliers, and makes room for these. ProtocolError where there are none.
void make_room_for_outliers(FrameletShape& shape) {
    std::size_t outliers = 0;
    for (std::uint8_t& kind : shape.layer_of) { // without an early end: many at a time
        bool const is_outlier = kind >= shape.layer_count;
        kind = is_outlier ? FrameletShape::outlier : kind;
        outliers += is_outlier ? 1 : 0;
    }
    if (outliers == 0) {
        throw ProtocolError("a shape has none of the outliers that it announces");
    }
    shape.outliers.resize(outliers);
}

void check(FrameletShape const& shape) {
    FRAMELET_CHECK(shape.layer_count <= max_layers);
    std::size_t outliers = 0, none = 0;
    for (std::uint8_t const layer : shape.layer_of) { // without an early end: many at a time
        outliers += layer == FrameletShape::outlier ? 1 : 0;
        none += layer >= shape.layer_count ? 1 : 0;
    }
    FRAMELET_CHECK(outliers == none && outliers == shape.outliers.size());
}

} // namespace

LayerCode continued(CodedLayer const& layer, UnitCode unit, TilePosition const& position) {
    LayerCode const& code = layer.code;
    int const bits = layer.position.side_bits;
    int const finer = int{code.unit} - int{unit}; // logarithm to base 2 of how much larger the old unit is
    std::int64_t const right = std::int64_t{position.left} - layer.position.left;
    std::int64_t const down = std::int64_t{position.top} - layer.position.top;
    std::int64_t const at = (std::int64_t{code.at} << bits) + code.dx * right + code.dy * down;
    LayerCode out;
    out.unit = unit;
    out.at = scaled(at, finer - bits);
    out.dx = scaled(code.dx, finer + position.side_bits - bits);
    out.dy = scaled(code.dy, finer + position.side_bits - bits);
    return out;
}

template <class Coder>
BodyNumber ShapeModel::BodyModel::code(Coder& coder, BodyNumber last, BodyNumber body) {
    if (coder.bit(is_same, body == last)) {
        return last;
    }
    unsigned const upper = high.code(coder, body >> 8u);
    return static_cast<BodyNumber>(upper << 8 | low.code(coder, body & 255u));
}

/// Number of the remembered layer beside which a layer takes the fewest bits.
std::size_t ShapeModel::nearest(LayerCode const& code, BodyNumber body, TilePosition const& position) const {
    std::size_t best = 0;
    int least = std::numeric_limits<int>::max();
    for (std::size_t i = 0; i < layers_.size(); ++i) {
        constexpr int another_body = 12; // bits
        int const bits = cost(code, continued(layers_[i], code.unit, position)) +
                         (layers_[i].body == body ? 0 : another_body) + std::abs(layers_[i].code.unit - code.unit);
        if (bits < least) {
            least = bits;
            best = i;
        }
    }
    return best;
}

void ShapeModel::remember(CodedLayer const& layer) {
    std::shift_right(layers_.begin(), layers_.end(), 1);
    layers_[0] = layer;
}

template <class Coder, class AnyLayer>
void ShapeModel::code_layer(Coder& coder, TilePosition const& position, std::size_t number, AnyLayer& layer) {
    LayerCode code;
    if (!Coder::reads) {
        code = quantise(layer, position.side_bits);
    }
    std::size_t const source =
        sources_[number].code(coder, static_cast<unsigned>(Coder::reads ? 0 : nearest(code, layer.body, position)));
    CodedLayer const& from = layers_[source];
    code.unit = checked_unit(static_cast<unsigned>(static_cast<std::uint16_t>(
        from.code.unit + units_.code(coder, static_cast<std::int16_t>(code.unit - from.code.unit)))));
    LayerCode const expected = continued(from, code.unit, position);
    auto const coded = [&](std::size_t i, std::int16_t value, std::int16_t likely) {
        return sum(likely, planes_[i].code(coder, difference(value, likely)));
    };
    code.at = coded(0, code.at, expected.at);
    code.dx = coded(1, code.dx, expected.dx);
    code.dy = coded(2, code.dy, expected.dy);
    std::uint32_t const error = errors_.code(coder, code.error);
    if (error > 255) {
        throw ProtocolError("a shape has an error that is too large");
    }
    code.error = static_cast<std::uint8_t>(error);
    BodyNumber const body = layer_bodies_.code(coder, from.body, layer.body);
    if constexpr (Coder::reads) {
        layer = dequantise(code, position.side_bits);
        layer.body = body;
    }
    remember({code, body, position});
}

/// Codes which sample is of which kind, row by row: layers by their number, then the outliers.
template <class Coder, class Shape>
void ShapeModel::code_kinds(Coder& coder, unsigned kinds, Shape& shape) {
    constexpr std::size_t stride = framelet_side + 3; // two before a row, one behind it
    std::array<std::uint8_t, stride*(framelet_side + 1)> rows{};
    SamplePlane in_order{};
    if (!Coder::reads) {
        SamplePlane kinds_of;
        std::transform(shape.layer_of.begin(), shape.layer_of.end(), kinds_of.begin(),
                       [count = shape.layer_count](std::uint8_t layer) { return std::min(layer, count); });
        to_rows(kinds_of.data(), in_order.data(), framelet_side);
    }
    auto& as_expected = as_expected_[kinds - 2];
    for (std::size_t y = 0; y < framelet_side; ++y) {
        for (std::size_t x = 0; x < framelet_side; ++x) {
            std::uint8_t* const at = &rows[(y + 1) * stride + x + 2];
            unsigned const left = at[-1], above = *(at - stride), corner = *(at - stride - 1),
                           right = *(at - stride + 1), second = at[-2];
            unsigned const expected = left == corner ? above : left;
            std::size_t const context = (left == above ? 1u : 0u) | (corner == left ? 2u : 0u) |
                                        (right == above ? 4u : 0u) | (second == left ? 8u : 0u) |
                                        (expected + 1 == kinds ? 16u : 0u) | (right == left ? 32u : 0u);
            unsigned kind = in_order[y * framelet_side + x];
            if (coder.bit(as_expected[context], kind == expected)) {
                kind = expected;
            } else if (kinds == 2) {
                kind = 1 - expected;
            } else {
                unsigned const turn = others_[kinds - 2][expected].code(coder, (kind + kinds - expected) % kinds - 1);
                if (turn + 1 >= kinds) {
                    throw ProtocolError("a shape has a sample on a layer that it does not have");
                }
                kind = (expected + turn + 1) % kinds;
            }
            *at = static_cast<std::uint8_t>(kind);
            in_order[y * framelet_side + x] = static_cast<std::uint8_t>(kind);
        }
        rows[(y + 1) * stride + framelet_side + 2] = rows[(y + 1) * stride + framelet_side + 1];
    }
    if constexpr (Coder::reads) {
        from_rows(in_order.data(), framelet_side, shape.layer_of.data());
    }
}

/// Codes outliers: inverse depths as differences from the outlier before, 0 before the first, and bodies.
template <class Coder, class Shape>
void ShapeModel::code_outliers(Coder& coder, Shape& shape) {
    UnitCode const own = Coder::reads ? UnitCode{0} : outlier_unit(shape);
    outlier_unit_ = checked_unit(static_cast<unsigned>(static_cast<std::uint16_t>(
        outlier_unit_ + outlier_units_.code(coder, static_cast<std::int16_t>(own - outlier_unit_)))));
    double const unit = unit_of(outlier_unit_);
    std::uint8_t depth = 0;
    unsigned around = 255;
    BodyNumber body = shape.layer_count > 0 ? shape.layers[0].body : static_body;
    for (auto& sample : shape.outliers) {
        std::uint8_t const wanted =
            Coder::reads ? std::uint8_t{0} : quantise_inverse_depth(sample.inverse_depth, outlier_unit_);
        std::size_t const size_class =
            std::min<std::size_t>(static_cast<std::size_t>(std::bit_width(around)), size_classes - 1);
        auto const step =
            static_cast<std::int8_t>(outlier_depths_[size_class].code(coder, static_cast<std::int8_t>(wanted - depth)));
        depth = static_cast<std::uint8_t>(depth + step);
        around = static_cast<unsigned>(std::abs(int{step}));
        body = outlier_bodies_.code(coder, body, sample.body);
        if constexpr (Coder::reads) {
            sample.inverse_depth = static_cast<float>(depth * unit);
            sample.body = body;
        }
    }
}

/// Codes `count` values of a drift beside the last one, which becomes it.
template <class Coder>
void ShapeModel::code_drift(Coder& coder, std::size_t count, DriftCode& last, DriftCode const& own) {
    bool const is_same =
        std::equal(own.values.begin(), own.values.begin() + static_cast<std::ptrdiff_t>(count), last.values.begin()) &&
        own.jerk == last.jerk && own.swing == last.swing;
    if (coder.bit(drifts_.is_same, is_same)) {
        return;
    }
    for (std::size_t i = 0; i < count; ++i) {
        last.values[i] = sum(last.values[i], drifts_.values[i].code(coder, difference(own.values[i], last.values[i])));
    }
    last.jerk = static_cast<JerkCode>(drifts_.jerk.code(coder, own.jerk));
    last.swing = static_cast<SwingCode>(drifts_.swing.code(coder, own.swing));
}

/// Codes the drifts of layers and outliers, each beside the one before.
template <class Coder, class Shape>
void ShapeModel::code_drifts(Coder& coder, TilePosition const& position, Shape& shape) {
    bool any = false;
    for_each_carried(shape, [&](auto const& carried) { any = any || carried.drift.any(); });
    if (!coder.bit(drifts_.any, any)) {
        return;
    }
    bool const is_brief = coder.bit(drifts_.is_brief, shape.is_brief);
    if constexpr (Coder::reads) {
        shape.is_brief = is_brief;
    }
    double const side = std::ldexp(1.0, position.side_bits);
    DriftUnits units = Coder::reads ? DriftUnits{} : drift_units(shape, side);
    units.velocity = checked_unit(drifts_.velocity_unit.code(coder, units.velocity));
    units.acceleration = checked_unit(drifts_.acceleration_unit.code(coder, units.acceleration));
    DriftCode last;
    for_each_carried(shape, [&](auto& carried) {
        DriftCode own;
        std::size_t count = 0;
        for_each_vector(carried.drift, side, [&](auto const& vector, bool is_acceleration, double scale) {
            for (int axis = 0; axis < 3; ++axis) {
                own.values[count++] =
                    quantise_drift(static_cast<float>(scale) * vector[axis], units.of(is_acceleration));
            }
        });
        own.jerk = quantise_jerk(common_in(carried.drift).jerk);
        own.swing = common_in(carried.drift).swing;
        code_drift(coder, count, last, own);
        if constexpr (Coder::reads) {
            count = 0;
            for_each_vector(carried.drift, side, [&](Vec3& vector, bool is_acceleration, double scale) {
                for (int axis = 0; axis < 3; ++axis) {
                    vector[axis] =
                        static_cast<float>(last.values[count++] * unit_of(units.of(is_acceleration)) / scale);
                }
            });
            common_in(carried.drift).jerk = jerk_of(last.jerk);
            common_in(carried.drift).swing = last.swing;
        }
    });
}

template <class Coder, class Shape>
void ShapeModel::code(Coder& coder, TilePosition const& position, Shape& shape) {
    constexpr unsigned outlier_bit = 4;
    unsigned const own = shape.layer_count + (shape.outliers.empty() ? 0u : outlier_bit);
    unsigned const head = heads_[head_].code(coder, own);
    if (head == 0) {
        throw ProtocolError("a shape has neither layers nor outliers");
    }
    head_ = static_cast<std::uint8_t>(head);
    bool const has_outliers = head >= outlier_bit;
    if (!coder.bit(same_decorrelation_, shape.decorrelation == decorrelation_)) {
        decorrelation_ = static_cast<DecorrelationCode>(decorrelations_.code(coder, shape.decorrelation));
    }
    if constexpr (Coder::reads) {
        shape.layer_count = static_cast<std::uint8_t>(head % outlier_bit);
        shape.decorrelation = decorrelation_;
    }
    for (std::size_t l = 0; l < shape.layer_count; ++l) {
        code_layer(coder, position, l, shape.layers[l]);
    }
    unsigned const kinds = shape.layer_count + (has_outliers ? 1u : 0u);
    if (kinds > 1) {
        code_kinds(coder, kinds, shape);
    } else if constexpr (Coder::reads) {
        shape.layer_of.fill(0);
    }
    if (has_outliers) {
        if constexpr (Coder::reads) {
            make_room_for_outliers(shape);
        }
        code_outliers(coder, shape);
    }
    code_drifts(coder, position, shape);
}

void ShapeModel::write(RangeWriter& writer, TilePosition const& position, FrameletShape const& shape) {
    check(shape);
    code(writer, position, shape);
}

void ShapeModel::read(RangeReader& reader, TilePosition const& position, FrameletShape& shape) {
    shape.layers = {};
    shape.decorrelation = 0;
    shape.is_brief = false;
    shape.layer_count = 0;
    shape.outliers.clear();
    code(reader, position, shape);
}

} // namespace framelet
