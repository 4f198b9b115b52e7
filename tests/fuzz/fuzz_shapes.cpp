// Decodes shapes of a group of framelets. Input: one byte, the number of framelets; a frame.
#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "protocol/codec/geometry/shape_coding.h"

namespace {

using namespace framelet;

/// Position of a tile: tiles of all sizes, here and there.
TilePosition position_of(std::size_t number) {
    constexpr std::int32_t least_bits = 2, sizes = 6;
    auto const i = static_cast<std::int32_t>(number);
    std::int32_t const bits = least_bits + i % sizes;
    return {i * 7 % 16 << bits, i * 5 % 16 << bits, bits};
}

void read(ShapeModel& model, std::span<std::uint8_t const> bytes, std::span<FrameletShape> shapes) {
    RangeReader reader(bytes);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        model.read(reader, position_of(i), shapes[i]);
    }
    if (!reader.is_at_end()) {
        throw ProtocolError("the frame is longer than its shapes");
    }
}

/// True where a shape is what a reader makes of another one: its planes are quantised, the rest but for depths of
/// samples and drifts is the same, and these are within half a unit.
bool is_quantised(FrameletShape const& got, FrameletShape const& sent, int side_bits) {
    if (got.layer_count != sent.layer_count || got.decorrelation != sent.decorrelation ||
        got.layer_of != sent.layer_of || got.outliers.size() != sent.outliers.size()) {
        return false;
    }
    float deepest = 0, fastest = 0, quickest = 0;
    float const side = std::ldexp(1.0f, side_bits);
    auto const note = [&](Drift const& drift, float scale) {
        for (int axis = 0; axis < 3; ++axis) {
            fastest = std::max(fastest, scale * std::abs(drift.velocity[axis]));
            quickest = std::max(quickest, scale * std::abs(drift.acceleration[axis]));
        }
    };
    for (std::size_t l = 0; l < sent.layer_count; ++l) {
        LayerDrift const& drift = sent.layers[l].drift;
        note(drift.corner, 1);
        note({drift.velocity_dx, drift.acceleration_dx}, side);
        note({drift.velocity_dy, drift.acceleration_dy}, side);
    }
    for (Outlier const& sample : sent.outliers) {
        note(sample.drift, 1);
        deepest = std::max(deepest, sample.inverse_depth);
    }
    auto const is_near = [&](Drift const& a, Drift const& b, float scale) {
        auto const half_unit = [&](float most) {
            return unit_of(unit_above(static_cast<double>(most) / largest_drift_code)) / 2 / static_cast<double>(scale);
        };
        bool near = a.jerk == jerk_of(quantise_jerk(b.jerk)) && a.swing == b.swing;
        for (int axis = 0; axis < 3; ++axis) {
            auto const off = [&](Vec3 const& one, Vec3 const& other) {
                return std::abs(static_cast<double>(one[axis]) - static_cast<double>(other[axis]));
            };
            near = near && off(a.velocity, b.velocity) <= half_unit(fastest) &&
                   off(a.acceleration, b.acceleration) <= half_unit(quickest);
        }
        return near;
    };
    for (std::size_t l = 0; l < sent.layer_count; ++l) {
        Layer wanted = dequantise(quantise(sent.layers[l], side_bits), side_bits);
        wanted.body = sent.layers[l].body;
        LayerDrift const& drift = got.layers[l].drift;
        LayerDrift const& whole = sent.layers[l].drift;
        wanted.drift = drift;
        if (got.layers[l] != wanted || !is_near(drift.corner, whole.corner, 1) ||
            !is_near({drift.velocity_dx, drift.acceleration_dx}, {whole.velocity_dx, whole.acceleration_dx}, side) ||
            !is_near({drift.velocity_dy, drift.acceleration_dy}, {whole.velocity_dy, whole.acceleration_dy}, side)) {
            return false;
        }
    }
    double const half_unit = unit_of(unit_above(static_cast<double>(deepest) / largest_inverse_depth_code)) / 2;
    return std::equal(
        got.outliers.begin(), got.outliers.end(), sent.outliers.begin(), [&](Outlier const& a, Outlier const& b) {
            double const off = std::abs(static_cast<double>(a.inverse_depth) - static_cast<double>(b.inverse_depth));
            return a.body == b.body && off <= half_unit && is_near(a.drift, b.drift, 1);
        });
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    if (size < 1) {
        return 0;
    }
    std::vector<FrameletShape> shapes(data[0] % 129u);
    ShapeModel reading; // new for each input: an input that fails does so alone
    try {
        read(reading, {data + 1, size - 1}, shapes);
    } catch (ProtocolError const&) {
        return 0;
    }
    // Shapes that were taken can be sent again, and arrive; the second time with what the first has taught.
    reading = {};
    ShapeModel writing;
    RangeWriter writer;
    for (int round = 0; round < 2; ++round) {
        writer.begin();
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            writing.write(writer, position_of(i), shapes[i]);
        }
        std::vector<FrameletShape> arrived(shapes.size());
        read(reading, writer.finish(), arrived);
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            FRAMELET_CHECK(is_quantised(arrived[i], shapes[i], position_of(i).side_bits));
        }
    }
    return 0;
}
