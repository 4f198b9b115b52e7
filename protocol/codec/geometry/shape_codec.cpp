#include "protocol/codec/geometry/shape_codec.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "common/error.h"
#include "protocol/codec/entropy/byte_cursor.h"
#include "protocol/codec/entropy/zigzag.h"
#include "protocol/codec/geometry/shape_masks.h"
#include "protocol/codec/geometry/shape_quantisation.h"

namespace framelet {
namespace {

using Words = std::vector<std::uint16_t>;

/// All low bytes, then all high bytes.
void put_words(std::vector<std::uint8_t>& out, Words const& words) {
    for (std::uint16_t const word : words) {
        out.push_back(static_cast<std::uint8_t>(word));
    }
    for (std::uint16_t const word : words) {
        out.push_back(static_cast<std::uint8_t>(word >> 8));
    }
}

class WordReader {
public:
    WordReader(ByteCursor& bytes, std::size_t count) : low_(bytes.take(count)), high_(bytes.take(count)) {}
    std::uint16_t operator[](std::size_t i) const { return static_cast<std::uint16_t>(low_[i] | high_[i] << 8); }
    std::int16_t number(std::size_t i) const { return from_zigzag((*this)[i]); }

private:
    std::span<std::uint8_t const> low_, high_;
};

/// Calls `use` for every layer of every shape in turn, or every loose sample.
template <typename Shapes, typename Use>
void for_each_layer(Shapes const& shapes, Use const& use) {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        for (std::size_t l = 0; l < shapes[i].layer_count; ++l) {
            use(shapes[i].layers[l], i);
        }
    }
}
template <typename Shapes, typename Use>
void for_each_loose(Shapes const& shapes, Use const& use) {
    for (auto& shape : shapes) {
        for (auto& sample : shape.loose_samples) {
            use(sample);
        }
    }
}
/// The same for both, layers first.
template <typename Shapes, typename Use>
void for_each_carried(Shapes const& shapes, Use const& use) {
    for_each_layer(shapes, [&](auto& layer, std::size_t) { use(layer); });
    for_each_loose(shapes, use);
}

/// The smallest unit in which the velocities of the group are; 0: nothing moves so.
UnitCode velocity_unit(std::span<FrameletShape const> shapes) {
    float largest = 0;
    for_each_carried(shapes, [&](auto const& carried) {
        for (int axis = 0; axis < 3; ++axis) {
            largest = std::max(largest, std::abs(carried.velocity[axis]));
        }
    });
    return unit_above(static_cast<double>(largest) / largest_velocity_code);
}

UnitCode loose_unit(FrameletShape const& shape) {
    float largest = 0;
    for (LooseSample const& sample : shape.loose_samples) {
        FRAMELET_CHECK(sample.inverse_depth >= 0);
        largest = std::max(largest, sample.inverse_depth);
    }
    return unit_above(static_cast<double>(largest) / largest_inverse_depth_code);
}

UnitCode take_unit(std::uint8_t byte) {
    if (byte > largest_unit) {
        throw ProtocolError("a shape has an unknown unit");
    }
    return byte;
}

void encode_layers(std::span<FrameletShape const> shapes, std::span<std::uint8_t const> side_bits,
                   std::vector<std::uint8_t>& out) {
    std::vector<LayerCode> codes;
    Words at, dx, dy, body;
    for_each_layer(shapes, [&](Layer const& layer, std::size_t i) {
        LayerCode const& code = codes.emplace_back(quantise(layer, side_bits[i]));
        at.push_back(zigzag(code.at));
        dx.push_back(zigzag(code.dx));
        dy.push_back(zigzag(code.dy));
        body.push_back(layer.body);
    });
    std::transform(codes.begin(), codes.end(), std::back_inserter(out), [](LayerCode const& c) { return c.unit; });
    std::transform(codes.begin(), codes.end(), std::back_inserter(out), [](LayerCode const& c) { return c.error; });
    for (Words const* const words : {&at, &dx, &dy, &body}) {
        put_words(out, *words);
    }
}

void decode_layers(ByteCursor& bytes, std::span<std::uint8_t const> side_bits, std::span<FrameletShape> shapes) {
    std::size_t count = 0;
    for (FrameletShape const& shape : shapes) {
        count += shape.layer_count;
    }
    auto const units = bytes.take(count), errors = bytes.take(count);
    WordReader const at(bytes, count), dx(bytes, count), dy(bytes, count), body(bytes, count);
    std::size_t next = 0;
    for_each_layer(shapes, [&](Layer& layer, std::size_t i) {
        LayerCode const code{take_unit(units[next]), errors[next], at.number(next), dx.number(next), dy.number(next)};
        layer = dequantise(code, side_bits[i]);
        layer.body = body[next];
        ++next;
    });
}

/// Inverse depths as differences from the sample before of the same framelet, 0 before the first.
void encode_loose(std::span<FrameletShape const> shapes, std::vector<std::uint8_t>& out) {
    std::vector<std::uint8_t> depths;
    Words bodies;
    for (FrameletShape const& shape : shapes) {
        if (!shape.loose_samples.empty()) {
            UnitCode const unit = loose_unit(shape);
            out.push_back(unit);
            std::uint8_t before = 0;
            for (LooseSample const& sample : shape.loose_samples) {
                std::uint8_t const depth = quantise_inverse_depth(sample.inverse_depth, unit);
                depths.push_back(zigzag(static_cast<std::int8_t>(depth - before)));
                bodies.push_back(sample.body);
                before = depth;
            }
        }
    }
    out.insert(out.end(), depths.begin(), depths.end());
    put_words(out, bodies);
}

/// Takes place for so many loose samples of each shape that its layers say.
void decode_loose(ByteCursor& bytes, std::span<FrameletShape> shapes) {
    std::size_t framelets = 0, count = 0;
    for (FrameletShape const& shape : shapes) {
        framelets += shape.loose_samples.empty() ? 0 : 1;
        count += shape.loose_samples.size();
    }
    auto units = bytes.take(framelets).begin();
    auto const depths = bytes.take(count);
    WordReader const bodies(bytes, count);
    std::size_t next = 0;
    for (FrameletShape& shape : shapes) {
        if (shape.loose_samples.empty()) {
            continue;
        }
        double const unit = unit_of(take_unit(*units++));
        std::uint8_t depth = 0;
        for (LooseSample& sample : shape.loose_samples) {
            depth = static_cast<std::uint8_t>(depth + from_zigzag(depths[next]));
            sample.inverse_depth = static_cast<float>(depth * unit);
            sample.body = bodies[next];
            ++next;
        }
    }
}

void encode_velocities(std::span<FrameletShape const> shapes, UnitCode unit, std::vector<std::uint8_t>& out) {
    for (int axis = 0; axis < 3 && unit != 0; ++axis) {
        Words words;
        for_each_carried(shapes, [&](auto const& carried) {
            words.push_back(zigzag(quantise_velocity(carried.velocity[axis], unit)));
        });
        put_words(out, words);
    }
}

void decode_velocities(ByteCursor& bytes, UnitCode code, std::span<FrameletShape> shapes) {
    std::size_t count = 0;
    for (FrameletShape const& shape : shapes) {
        count += shape.layer_count + shape.loose_samples.size();
    }
    for (int axis = 0; axis < 3 && code != 0; ++axis) {
        WordReader const words(bytes, count);
        std::size_t next = 0;
        for_each_carried(shapes, [&](auto& carried) {
            carried.velocity[axis] = static_cast<float>(words.number(next++) * unit_of(code));
        });
    }
}

} // namespace

ShapeParts ShapeCodec::encode(std::span<FrameletShape const> shapes, std::span<std::uint8_t const> side_bits) {
    FRAMELET_CHECK(shapes.size() == side_bits.size());
    layers_.clear();
    masks_.clear();
    loose_.clear();
    for (FrameletShape const& shape : shapes) {
        FRAMELET_CHECK(shape.layer_count <= max_layers);
        layers_.push_back(shape_head(shape));
    }
    UnitCode const unit = velocity_unit(shapes);
    layers_.push_back(unit);
    std::ranges::transform(shapes, std::back_inserter(layers_), &FrameletShape::fading);
    encode_layers(shapes, side_bits, layers_);
    encode_masks(shapes, masks_);
    encode_loose(shapes, loose_);
    encode_velocities(shapes, unit, loose_);
    return {layers_, masks_, loose_};
}

void ShapeCodec::decode(std::span<std::uint8_t const> bytes, std::span<std::uint8_t const> side_bits,
                        std::span<FrameletShape> shapes) {
    FRAMELET_CHECK(shapes.size() == side_bits.size());
    ByteCursor rest{bytes.data(), bytes.data() + bytes.size()};
    auto const heads = rest.take(shapes.size());
    UnitCode const velocity = take_unit(rest.take(1)[0]);
    auto const fadings = rest.take(shapes.size());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        if (heads[i] == 0 || heads[i] > largest_shape_head) {
            throw ProtocolError("a shape has an unknown number of layers");
        }
        shapes[i].layer_count = layers_of_head(heads[i]);
        shapes[i].fading = fadings[i];
        shapes[i].layers = {};
        shapes[i].loose_samples.clear();
    }
    decode_layers(rest, side_bits, shapes);
    decode_masks(rest, heads, shapes);
    decode_loose(rest, shapes);
    decode_velocities(rest, velocity, shapes);
    if (rest.left() != 0) {
        throw ProtocolError("the shapes of a group are longer than its framelets");
    }
}

} // namespace framelet
