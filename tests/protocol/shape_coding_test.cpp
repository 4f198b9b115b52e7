#include "protocol/codec/geometry/shape_coding.h"

#include <cmath>

#include <gtest/gtest.h>

#include "common/error.h"
#include "random_shape.h"

namespace framelet {
namespace {

using Plain = std::vector<std::uint8_t>;

/// Positions of tiles of 2^side_bits pixels a side, side by side.
std::vector<TilePosition> positions_of(std::span<std::uint8_t const> side_bits) {
    std::vector<TilePosition> positions;
    std::int32_t left = 0;
    for (std::uint8_t const bits : side_bits) {
        positions.push_back({left, 3 * left, bits});
        left += 1 << bits;
    }
    return positions;
}

/// Encodes shapes as the first group of a session.
Plain bytes_of(std::span<FrameletShape const> shapes, std::span<std::uint8_t const> side_bits) {
    auto const positions = positions_of(side_bits);
    ShapeModel model;
    RangeWriter writer;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        model.write(writer, positions[i], shapes[i]);
    }
    auto const bytes = writer.finish();
    return {bytes.begin(), bytes.end()};
}

std::vector<FrameletShape> shapes_of(Plain const& bytes, std::span<std::uint8_t const> side_bits) {
    auto const positions = positions_of(side_bits);
    std::vector<FrameletShape> shapes(side_bits.size());
    ShapeModel model;
    RangeReader reader(bytes);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        model.read(reader, positions[i], shapes[i]);
    }
    return shapes;
}

std::string refusal(Plain const& bytes, std::size_t count) {
    try {
        shapes_of(bytes, Plain(count, 4));
        return "accepted";
    } catch (ProtocolError const& error) {
        return error.what();
    }
}

double value_at(Layer const& layer, double x, double y) {
    return static_cast<double>(layer.at) + static_cast<double>(layer.dx) * x + static_cast<double>(layer.dy) * y;
}

float largest(Vec3 const& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

/// The largest components of velocities and of accelerations on a shape of that side, whatever has them.
struct FastestDrift {
    float velocity = 0, acceleration = 0;

    void add(Drift const& drift) {
        velocity = std::max(velocity, largest(drift.velocity));
        acceleration = std::max(acceleration, largest(drift.acceleration));
    }
    void add(LayerDrift const& drift, float side) {
        add(drift.corner);
        add({side * drift.velocity_dx, side * drift.acceleration_dx});
        add({side * drift.velocity_dy, side * drift.acceleration_dy});
    }
};

/// Expects a drift to be as it was, but for a share of the fastest; a jerk is no less than it was.
void expect_close(Drift const& in, Drift const& out, FastestDrift const& fastest) {
    EXPECT_LE(largest(in.velocity - out.velocity), fastest.velocity / 32767 + 1e-30f);
    EXPECT_LE(largest(in.acceleration - out.acceleration), fastest.acceleration / 32767 + 1e-30f);
    EXPECT_EQ(out.swing, in.swing);
    EXPECT_GE(out.jerk, 0.999f * in.jerk);
    EXPECT_LE(out.jerk, std::max(1.0915f * in.jerk, 2e-5f));
}

/// Expects that a shape has lost no more than it may. `fastest`: of its group.
void expect_close(FrameletShape const& in, FrameletShape const& out, int side_bits, FastestDrift const& fastest) {
    ASSERT_EQ(in.layer_count, out.layer_count);
    ASSERT_EQ(in.layer_of, out.layer_of);
    ASSERT_EQ(in.outliers.size(), out.outliers.size());
    double const side = std::ldexp(1.0, side_bits);
    for (std::size_t l = 0; l < in.layer_count; ++l) {
        Layer const& a = in.layers[l];
        Layer const& b = out.layers[l];
        EXPECT_EQ(a.body, b.body);
        expect_close(a.drift.corner, b.drift.corner, fastest);
        Vec2 const across(0.7f * static_cast<float>(side), static_cast<float>(side));
        FastestDrift const summed{3 * fastest.velocity, 3 * fastest.acceleration};
        expect_close(a.drift.at(across), b.drift.at(across), summed);
        double const error = static_cast<double>(a.error);
        double const magnitude = std::abs(static_cast<double>(a.at)) +
                                 side * (std::abs(static_cast<double>(a.dx)) + std::abs(static_cast<double>(a.dy)));
        double const unit = std::max(error / 8, std::ldexp(magnitude, -9)) + 1e-37;
        for (double const x : {0.0, side}) {
            for (double const y : {0.0, side}) {
                double const off = std::abs(value_at(a, x, y) - value_at(b, x, y));
                EXPECT_LE(off, 1.5 * unit);
                EXPECT_LE(off + error, static_cast<double>(b.error)) << "what lies on the layer still lies on it";
            }
        }
        EXPECT_LE(static_cast<double>(b.error), error + 2.5 * unit);
    }
    float nearest = 0;
    for (Outlier const& sample : in.outliers) {
        nearest = std::max(nearest, sample.inverse_depth);
    }
    for (std::size_t i = 0; i < in.outliers.size(); ++i) {
        EXPECT_EQ(in.outliers[i].body, out.outliers[i].body);
        EXPECT_NEAR(in.outliers[i].inverse_depth, out.outliers[i].inverse_depth, nearest / 255 + 1e-37f);
        EXPECT_GE(out.outliers[i].inverse_depth, 0);
        expect_close(in.outliers[i].drift, out.outliers[i].drift, fastest);
    }
}

TEST(ShapeCoding, RoundTripsLoseNoMoreThanStated) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        RandomShapes random(seed);
        bool const deforms = random.integer(0, 1) == 1;
        std::vector<FrameletShape> shapes(random.integer(0, 40));
        std::vector<std::uint8_t> side_bits;
        FastestDrift fastest;
        for (FrameletShape& shape : shapes) {
            shape = random.shape(deforms);
            side_bits.push_back(static_cast<std::uint8_t>(random.integer(2, 7)));
            for (std::size_t l = 0; l < shape.layer_count; ++l) {
                fastest.add(shape.layers[l].drift, std::ldexp(1.0f, side_bits.back()));
            }
            for (Outlier const& sample : shape.outliers) {
                fastest.add(sample.drift);
            }
        }
        Plain const bytes = bytes_of(shapes, side_bits);
        std::vector<FrameletShape> const out = shapes_of(bytes, side_bits);
        for (std::size_t i = 0; i < shapes.size(); ++i) {
            expect_close(shapes[i], out[i], side_bits[i], fastest);
        }
        EXPECT_EQ(bytes_of(shapes, side_bits), bytes);
    }
}

TEST(ShapeCoding, MasksOfAnyPatternAreExact) {
    std::uint8_t const side_bits = 4;
    for (std::uint32_t pattern = 0; pattern < 5 + framelet_samples; ++pattern) {
        FrameletShape shape;
        shape.layer_count = static_cast<std::uint8_t>(pattern % 3 + 1);
        for (std::uint32_t i = 0; i < framelet_samples; ++i) {
            std::uint32_t const x = morton_x(i), y = morton_y(i);
            std::array const kinds{x, y, x + y, x ^ y, x * y, i == pattern - 5 ? 1u : 0u}; // the last: one sample
            std::uint32_t const kind = kinds[std::min(pattern, 5u)] % (shape.layer_count + 1u);
            shape.layer_of[i] = kind < shape.layer_count ? static_cast<std::uint8_t>(kind) : FrameletShape::outlier;
            if (kind == shape.layer_count) {
                shape.outliers.push_back({});
            }
        }
        Plain const bytes = bytes_of({&shape, 1}, {&side_bits, 1});
        EXPECT_EQ(shapes_of(bytes, {&side_bits, 1})[0], shape) << pattern;
    }
}

TEST(ShapeCoding, ExtremesStayFinite) {
    for (float const scale : {0.0f, 1e-45f, 1e-38f, 1e-30f, 1.0f, 1e9f, 1e38f}) {
        for (std::uint8_t const side_bits : {std::uint8_t{0}, std::uint8_t{7}}) {
            FrameletShape shape;
            shape.layer_count = 1;
            Vec3 const fast(scale, -scale, 0);
            shape.layers[0] = {scale, -scale, scale, scale, 65535, {{fast, fast, scale}, fast, fast, fast, fast}};
            FrameletShape const out = shapes_of(bytes_of({&shape, 1}, {&side_bits, 1}), {&side_bits, 1})[0];
            Layer const& layer = out.layers[0];
            for (float const value : {layer.at, layer.dx, layer.dy, layer.error, layer.drift.corner.velocity.x,
                                      layer.drift.acceleration_dy.z}) {
                EXPECT_TRUE(std::isfinite(value));
            }
            EXPECT_GE(layer.error, std::min(scale, 1e9f));
        }
    }
}

TEST(ShapeCoding, WhatIsOneLayerCostsNearlyNothing) {
    FrameletShape shape;
    shape.layer_count = 1;
    std::vector const shapes(128, shape);
    std::vector<std::uint8_t> const side_bits(128, 4);
    EXPECT_LT(bytes_of(shapes, side_bits).size(), 128u);
}

/// The example of PROTOCOL.md: columns 0..3 on the first layer, 4..14 on the second, the last column outliers.
FrameletShape documented_shape() {
    FrameletShape shape;
    shape.layer_count = 2;
    shape.decorrelation = 90;
    shape.layers[0] = {0.5f, 0.0078125f, -0.015625f, 0.001f, static_body, {}};
    shape.layers[1] = {0.25f, 0, 0, 0, 258, {}};
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        std::uint32_t const x = morton_x(i);
        shape.layer_of[i] = x < 4 ? 0 : x < 15 ? 1 : FrameletShape::outlier;
        if (x == 15) {
            shape.outliers.push_back({morton_y(i) == 0 ? 1.0f : 0.5f, 3, {}});
        }
    }
    return shape;
}

TEST(ShapeCoding, GoldenBytes) {
    Plain const golden{0x3a, 0x5d, 0x80, 0x97, 0x00, 0x10, 0x18, 0x02, 0x0c, 0x00, 0x81, 0x17, 0x45, 0x1a, 0xe3, 0xed,
                       0x47, 0x6c, 0x06, 0x42, 0x67, 0x45, 0xcf, 0x39, 0x01, 0xcc, 0xc0, 0x00, 0x00, 0x00, 0x00, 0x00,
                       0x00, 0x00, 0x00, 0x22, 0x56, 0xa7, 0xdf, 0xc7, 0xe1, 0xb2, 0xf0, 0x61, 0x3e, 0x40};
    FrameletShape const shape = documented_shape();
    std::uint8_t const side_bits = 4;
    EXPECT_EQ(bytes_of({&shape, 1}, {&side_bits, 1}), golden);
    FrameletShape expected = shape;
    expected.layers[0].error = 2 * 0x1p-10f;
    EXPECT_EQ(shapes_of(golden, {&side_bits, 1})[0], expected);
}

TEST(ShapeCoding, APlaneGoesOnInTilesOfAnySizeAndUnit) {
    // The plane is w = 0.5 + x / 128 - y / 64 from the corner of a tile of 16 pixels at (32, 48).
    TilePosition const from{32, 48, 4};
    CodedLayer const layer{quantise({0.5f, 0.0078125f, -0.015625f, 0, static_body, {}}, 4), static_body, from};
    for (std::int32_t side_bits = 2; side_bits <= 7; ++side_bits) {
        for (int const finer : {-2, 0, 3}) {
            TilePosition const to{32 + 64, 48 + 8, side_bits};
            auto const unit = static_cast<UnitCode>(layer.code.unit - finer);
            Layer const on = dequantise(continued(layer, unit, to), side_bits);
            double const off = 1.01 * unit_of(unit);
            EXPECT_NEAR(on.at, 0.5 + 64.0 / 128 - 8.0 / 64, off);
            EXPECT_NEAR(on.dx * std::ldexp(1.0, side_bits), std::ldexp(1.0, side_bits) / 128, off);
            EXPECT_NEAR(on.dy * std::ldexp(1.0, side_bits), -std::ldexp(1.0, side_bits) / 64, off);
        }
    }
}

TEST(ShapeCoding, APlaneGoesOnWithinWhatNumbersHoldWhateverIsAsked) {
    RandomShapes random(3);
    for (int i = 0; i < 200000; ++i) {
        auto const any = [&] { return static_cast<std::int16_t>(random.integer(0, 65535)); };
        auto const pixel = [&] { return static_cast<std::int32_t>(random.integer(0, 1u << 17)); };
        auto const bits = [&] { return static_cast<std::int32_t>(random.integer(0, 17)); };
        auto const unit = [&] { return static_cast<UnitCode>(random.integer(0, largest_unit)); };
        CodedLayer const layer{{unit(), 0, any(), any(), any()}, static_body, {pixel(), pixel(), bits()}};
        UnitCode const to = unit();
        LayerCode const on = continued(layer, to, {pixel(), pixel(), bits()});
        EXPECT_EQ(on.unit, to); // and nothing overflows: the sanitizers see that
    }
}

TEST(ShapeCoding, PlanesOfNeighboursCostLittle) {
    std::vector<FrameletShape> shapes;
    std::vector<std::uint8_t> const side_bits(128, 4);
    for (int i = 0; i < 128; ++i) { // one plane, stated from each tile's corner
        FrameletShape& shape = shapes.emplace_back();
        shape.layer_count = 1;
        shape.layers[0] = {0.5f + static_cast<float>(16 * i) * 1e-4f - static_cast<float>(48 * i) * 2e-5f,
                           1e-4f,
                           -2e-5f,
                           1e-5f,
                           static_body,
                           {}};
    }
    EXPECT_LT(bytes_of(shapes, side_bits).size(), 128u * 4);
}

/// Expects that shapes which were read can be written, and say the same of every sample.
void expect_sent_again(std::vector<FrameletShape> const& shapes, std::span<std::uint8_t const> side_bits) {
    std::vector<FrameletShape> const again = shapes_of(bytes_of(shapes, side_bits), side_bits);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        EXPECT_EQ(again[i].layer_of, shapes[i].layer_of);
        EXPECT_EQ(again[i].decorrelation, shapes[i].decorrelation);
        EXPECT_EQ(again[i].outliers.size(), shapes[i].outliers.size());
    }
}

TEST(ShapeCoding, TruncatedBytesAreRefusedOrRead) {
    RandomShapes random(5);
    std::vector<FrameletShape> shapes;
    for (int i = 0; i < 6; ++i) {
        shapes.push_back(random.shape(true));
    }
    std::vector<std::uint8_t> const side_bits(shapes.size(), 4);
    Plain const whole = bytes_of(shapes, side_bits);
    for (std::size_t size = 0; size < whole.size(); ++size) {
        Plain const cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        if (refusal(cut, 6) == "accepted") {
            expect_sent_again(shapes_of(cut, side_bits), side_bits);
        }
    }
}

TEST(ShapeCoding, DamagedBytesAreRefusedOrGiveWhatCanBeSentAgain) {
    std::size_t accepted = 0, refused = 0;
    for (std::uint64_t seed = 0; seed < 4000; ++seed) {
        RandomShapes random(seed);
        std::vector<FrameletShape> shapes{random.shape(seed % 2 == 0), random.shape(false)};
        std::vector<std::uint8_t> const side_bits(shapes.size(), 4);
        Plain bytes = bytes_of(shapes, side_bits);
        for (std::uint32_t flips = random.integer(1, 3); flips > 0; --flips) {
            auto const end = static_cast<std::uint32_t>(random.integer(0, 1) == 0 ? 40 : bytes.size());
            bytes[random.integer(0, std::min<std::uint32_t>(end, static_cast<std::uint32_t>(bytes.size())) - 1)] =
                static_cast<std::uint8_t>(random.integer(0, 255));
        }
        if (refusal(bytes, 2) == "accepted") {
            ++accepted;
            std::vector<FrameletShape> const out = shapes_of(bytes, side_bits);
            expect_sent_again(out, side_bits);
        } else {
            ++refused;
        }
    }
    EXPECT_GT(accepted, 500u);
    EXPECT_GT(refused, 500u);
}

} // namespace
} // namespace framelet
