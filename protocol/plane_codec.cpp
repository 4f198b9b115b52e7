#include "protocol/plane_codec.h"

#include <algorithm>

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

} // namespace

PlaneParts PlaneCodec::encode(std::span<DisplayFramelet const> framelets, std::span<std::uint8_t const> quality) {
    FRAMELET_CHECK(framelets.size() == quality.size());
    auto const exact = static_cast<std::size_t>(std::count(quality.begin(), quality.end(), exact_quality));
    HaarWriter haar(haar_, framelets.size() - exact);
    head_.resize(quality.size() + exact * exact_framelet_bytes + haar.means().size() + 3 * length_bytes +
                 most_escape_bytes(coarse_details + fine_details) * (framelets.size() - exact));
    std::uint8_t* out = std::copy(quality.begin(), quality.end(), head_.data());
    for_each_plane([&](auto const plane) {
        for (std::size_t i = 0; i < framelets.size(); ++i) {
            if (quality[i] == exact_quality) {
                difference(framelets[i].*plane, out);
                out += framelet_samples;
            }
        }
    });
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        FRAMELET_CHECK(quality[i] <= coarsest_quality);
        if (quality[i] != exact_quality) {
            haar.write(framelets[i], quality[i]);
        }
    }
    out = std::copy(haar.means().begin(), haar.means().end(), out);
    for (auto const part : {haar.escapes(), haar.coarse(), haar.fine()}) {
        put_length(out, part.size());
        out += length_bytes;
    }
    out = std::copy(haar.escapes().begin(), haar.escapes().end(), out);
    return {std::span(head_.data(), out), haar.coarse(), haar.fine()};
}

void PlaneCodec::decode(std::span<std::uint8_t const> bytes, std::span<DisplayFramelet> framelets,
                        std::span<std::uint8_t> quality) {
    FRAMELET_CHECK(framelets.size() == quality.size());
    ByteCursor rest{bytes.data(), bytes.data() + bytes.size()};
    auto const qualities = rest.take(quality.size());
    if (std::any_of(qualities.begin(), qualities.end(), [](std::uint8_t q) { return q > coarsest_quality; })) {
        throw ProtocolError("a batch has a framelet of an unknown quality");
    }
    std::copy(qualities.begin(), qualities.end(), quality.begin());
    auto const exact = static_cast<std::size_t>(std::count(quality.begin(), quality.end(), exact_quality));
    std::uint8_t const* planes = rest.take(exact * exact_framelet_bytes).data();
    for_each_plane([&](auto const plane) {
        for (std::size_t i = 0; i < framelets.size(); ++i) {
            if (quality[i] == exact_quality) {
                undo_difference(planes, framelets[i].*plane);
                planes += framelet_samples;
            }
        }
    });
    auto const means = rest.take(mean_bytes * (framelets.size() - exact));
    std::size_t const escape_bytes = take_length(rest);
    std::size_t const coarse_bytes = take_length(rest);
    std::size_t const fine_bytes = take_length(rest);
    auto const escapes = rest.take(escape_bytes);
    auto const coarse = rest.take(coarse_bytes);
    auto const fine = rest.take(fine_bytes);
    HaarReader haar(means, escapes, coarse, fine);
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        if (quality[i] != exact_quality) {
            haar.read(framelets[i], quality[i]);
        }
    }
    if (rest.left() != 0 || !haar.is_at_end()) {
        throw ProtocolError("a group of a batch is longer than its framelets");
    }
}

} // namespace framelet
