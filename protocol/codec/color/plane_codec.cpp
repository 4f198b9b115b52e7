#include "protocol/codec/color/plane_codec.h"

#include <algorithm>
#include <array>
#include <limits>

#include "common/error.h"

namespace framelet {
namespace {

constexpr std::size_t length_bytes = 4;

void put_length(std::uint8_t* out, std::size_t length) {
    for (std::size_t i = 0; i < length_bytes; ++i) {
        out[i] = static_cast<std::uint8_t>(length >> (8 * i));
    }
}

std::size_t take_length(ByteCursor& bytes) {
    std::size_t length = 0;
    auto const field = bytes.take(length_bytes);
    for (std::size_t i = 0; i < length_bytes; ++i) {
        length |= std::size_t{field[i]} << (8 * i);
    }
    return length;
}

std::size_t count_exact(std::span<std::uint8_t const> quality) {
    return static_cast<std::size_t>(std::count(quality.begin(), quality.end(), exact_quality));
}

/// How each framelet of a group is predicted, as it was sent.
class PredictionReader {
public:
    PredictionReader(ByteCursor& bytes, std::size_t framelets) : kinds_(bytes.take(framelets)) {
        std::size_t moved = 0;
        for (std::uint8_t const kind : kinds_) {
            if (kind > static_cast<std::uint8_t>(PredictionKind::moved)) {
                throw ProtocolError("a batch has a framelet of an unknown prediction");
            }
            moved += kind == static_cast<std::uint8_t>(PredictionKind::moved) ? 1 : 0;
        }
        vectors_ = bytes.take(2 * moved);
    }

    /// Of the next framelet.
    void next(HeldPicture const& held, Tile tile, Prediction& prediction) {
        prediction.kind = static_cast<PredictionKind>(kinds_[read_++]);
        prediction.vector = {};
        if (prediction.kind == PredictionKind::moved) {
            prediction.vector = {static_cast<std::int8_t>(vectors_[0]), static_cast<std::int8_t>(vectors_[1])};
            vectors_ = vectors_.subspan(2);
        }
        if (prediction.kind != PredictionKind::none) {
            held.predict(tile, prediction.vector, prediction.samples);
        }
    }

private:
    std::span<std::uint8_t const> kinds_, vectors_;
    std::size_t read_ = 0;
};

/// Most are predicted from their own places.
void expect_next(HeldPicture const& held, std::span<DisplayFramelet const> framelets, std::size_t i) {
    if (i + 1 < framelets.size()) {
        held.expect(framelets[i + 1].tile);
    }
}

} // namespace

PlaneParts PlaneCodec::join(std::span<DisplayFramelet const> framelets, std::span<std::uint8_t const> quality,
                            HaarWriter const& haar) {
    head_.resize(quality.size() + kinds_.size() + vectors_.size() + count_exact(quality) * exact_framelet_bytes +
                 haar.shares().size() + haar.means().size() + (1 + token_parts) * length_bytes + haar.escapes().size());
    std::uint8_t* out = std::copy(quality.begin(), quality.end(), head_.data());
    out = std::copy(kinds_.begin(), kinds_.end(), out);
    out = std::copy(vectors_.begin(), vectors_.end(), out);
    for_each_plane([&](auto const plane) {
        for (std::size_t i = 0; i < framelets.size(); ++i) {
            if (quality[i] == exact_quality) {
                difference(framelets[i].*plane, out);
                out += framelet_samples;
            }
        }
    });
    out = std::copy(haar.shares().begin(), haar.shares().end(), out);
    out = std::copy(haar.means().begin(), haar.means().end(), out);
    put_length(out, haar.escapes().size());
    PlaneParts parts;
    for (std::size_t part = 0; part < token_parts; ++part) {
        parts[1 + part] = haar.tokens(part);
        out += length_bytes;
        put_length(out, parts[1 + part].size());
    }
    std::copy(haar.escapes().begin(), haar.escapes().end(), out + length_bytes);
    parts[0] = head_;
    return parts;
}

PlaneParts PlaneCodec::encode(std::span<DisplayFramelet const> framelets, std::span<std::uint8_t const> quality,
                              HeldPicture const* held, std::span<DisplayFramelet> decoded) {
    FRAMELET_CHECK(framelets.size() == quality.size());
    FRAMELET_CHECK(held == nullptr || decoded.size() == quality.size());
    HaarWriter haar(haar_, framelets.size() - count_exact(quality));
    kinds_.clear();
    vectors_.clear();
    search_.begin();
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        FRAMELET_CHECK(quality[i] <= coarsest_quality);
        if (quality[i] == exact_quality) {
            if (held != nullptr) {
                decoded[i] = framelets[i];
            }
        } else if (held == nullptr) {
            HaarCode alone;
            code(display_values(framelets[i]), quality[i], std::numeric_limits<int>::max(), alone);
            share_luma(quality[i], alone);
            haar.write(alone.levels);
        } else {
            expect_next(*held, framelets, i);
            HaarLevels const levels = predict(*held, framelets[i], quality[i], search_, prediction_);
            haar.write(levels);
            put_prediction();
            add_prediction(dequantise(levels, quality[i]), decoded[i]);
        }
    }
    return join(framelets, quality, haar);
}

void PlaneCodec::add_prediction(DisplayValues const& left, DisplayFramelet& framelet) const {
    if (prediction_.kind == PredictionKind::none) {
        to_samples(left, framelet);
    } else {
        add_to_samples(left, prediction_.samples, framelet);
    }
}

void PlaneCodec::put_prediction() {
    kinds_.push_back(static_cast<std::uint8_t>(prediction_.kind));
    if (prediction_.kind == PredictionKind::moved) {
        vectors_.push_back(static_cast<std::uint8_t>(prediction_.vector.x));
        vectors_.push_back(static_cast<std::uint8_t>(prediction_.vector.y));
    }
}

void PlaneCodec::decode(std::span<std::uint8_t const> bytes, std::span<DisplayFramelet> framelets,
                        std::span<std::uint8_t> quality, HeldPicture const* held) {
    FRAMELET_CHECK(framelets.size() == quality.size());
    ByteCursor rest{bytes.data(), bytes.data() + bytes.size()};
    auto const qualities = rest.take(quality.size());
    if (std::any_of(qualities.begin(), qualities.end(), [](std::uint8_t q) { return q > coarsest_quality; })) {
        throw ProtocolError("a batch has a framelet of an unknown quality");
    }
    std::copy(qualities.begin(), qualities.end(), quality.begin());
    std::size_t const exact = count_exact(quality);
    PredictionReader predictions(rest, held == nullptr ? 0 : framelets.size() - exact);
    std::uint8_t const* planes = rest.take(exact * exact_framelet_bytes).data();
    for_each_plane([&](auto const plane) {
        for (std::size_t i = 0; i < framelets.size(); ++i) {
            if (quality[i] == exact_quality) {
                undo_difference(planes, framelets[i].*plane);
                planes += framelet_samples;
            }
        }
    });
    auto const shares = rest.take(share_bytes * (framelets.size() - exact));
    auto const means = rest.take(mean_bytes * (framelets.size() - exact));
    std::size_t const escape_bytes = take_length(rest);
    std::array<std::size_t, token_parts> part_bytes;
    std::ranges::generate(part_bytes, [&] { return take_length(rest); });
    auto const escapes = rest.take(escape_bytes);
    HaarReader::Parts parts;
    std::ranges::transform(part_bytes, parts.begin(),
                           [&](std::size_t bytes_of_part) { return rest.take(bytes_of_part); });
    HaarReader haar(shares, means, escapes, parts);
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        if (quality[i] != exact_quality) {
            prediction_.kind = PredictionKind::none;
            if (held != nullptr) {
                expect_next(*held, framelets, i);
                predictions.next(*held, framelets[i].tile, prediction_);
            }
            add_prediction(haar.read(quality[i]), framelets[i]);
        }
    }
    if (rest.left() != 0 || !haar.is_at_end()) {
        throw ProtocolError("a group of a batch is longer than its framelets");
    }
}

} // namespace framelet
