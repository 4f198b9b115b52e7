#include "server/render/surface/texture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "common/color.h"
#include "common/error.h"

namespace framelet {
namespace {

/// More taps than this along the major axis buy little and cost a texture look-up each.
constexpr int max_taps = 4;

struct DecodeTables {
    std::array<float, 256> srgb, linear;

    DecodeTables() {
        for (std::size_t i = 0; i < 256; ++i) {
            linear[i] = static_cast<float>(i) / 255.0f;
            srgb[i] = linear_from_srgb(linear[i]);
        }
    }
};

DecodeTables const tables;

std::vector<std::uint8_t> halved(MipChain::Level const& from, int width, int height, TexelKind kind) {
    std::vector<std::uint8_t> out(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4);
    float const* decode = kind == TexelKind::linear ? tables.linear.data() : tables.srgb.data();
    std::uint8_t* texel = out.data();
    for (int y = 0; y < height; ++y) {
        // Odd sizes: the last row or column of the larger level is averaged in as well.
        int const y0 = static_cast<int>(std::int64_t(y) * from.height / height);
        int const y1 = std::max(y0 + 1, static_cast<int>(std::int64_t(y + 1) * from.height / height));
        for (int x = 0; x < width; ++x, texel += 4) {
            int const x0 = static_cast<int>(std::int64_t(x) * from.width / width);
            int const x1 = std::max(x0 + 1, static_cast<int>(std::int64_t(x + 1) * from.width / width));
            Vec3 sum(0), weighted(0);
            float alpha = 0, count = 0;
            for (int j = y0; j < y1; ++j) {
                for (int i = x0; i < x1; ++i) {
                    std::uint8_t const* in =
                        from.rgba + (static_cast<std::size_t>(j) * static_cast<std::size_t>(from.width) +
                                     static_cast<std::size_t>(i)) *
                                        4;
                    Vec3 const color(decode[in[0]], decode[in[1]], decode[in[2]]);
                    float const a = tables.linear[in[3]];
                    sum += color;
                    weighted += color * a;
                    alpha += a;
                    count += 1;
                }
            }
            Vec3 const mean = kind == TexelKind::color_alpha && alpha > 0 ? weighted / alpha : sum / count;
            for (int c = 0; c < 3; ++c) {
                texel[c] = kind == TexelKind::linear ? static_cast<std::uint8_t>(std::lround(mean[c] * 255))
                                                     : srgb_byte_from_linear(mean[c]);
            }
            texel[3] = static_cast<std::uint8_t>(std::lround(alpha / count * 255));
        }
    }
    return out;
}

/// The two texels on either side of a coordinate, and the weight of the second.
struct Pair {
    int first, second;
    float weight;
};

Pair texel_pair(float coordinate, int size, Wrap wrap) {
    if (!(std::abs(coordinate) < 1e6f)) { // beyond this a float no longer tells texels apart
        coordinate = 0;
    }
    if (wrap == Wrap::repeat) {
        coordinate -= std::floor(coordinate);
    } else if (wrap == Wrap::mirror) {
        coordinate -= 2 * std::floor(0.5f * coordinate);
        coordinate = coordinate > 1 ? 2 - coordinate : coordinate;
    } else {
        coordinate = std::clamp(coordinate, 0.0f, 1.0f);
    }
    float const position = coordinate * static_cast<float>(size) - 0.5f;
    float const whole = std::floor(position);
    int first = static_cast<int>(whole);
    int second = first + 1;
    if (wrap == Wrap::repeat) {
        first = first < 0 ? size - 1 : first;
        second = second >= size ? 0 : second;
    } else {
        first = std::max(first, 0);
        second = std::min(second, size - 1);
    }
    return {std::min(first, size - 1), second, position - whole};
}

} // namespace

MipChain::MipChain(std::shared_ptr<Picture const> picture, TexelKind kind) : picture_(std::move(picture)), kind_(kind) {
    FRAMELET_CHECK(picture_ && picture_->width > 0 && picture_->height > 0);
    levels_.push_back({picture_->width, picture_->height, picture_->rgba.data()});
    while (levels_.back().width > 1 || levels_.back().height > 1) {
        Level const from = levels_.back();
        int const width = std::max(1, from.width / 2);
        int const height = std::max(1, from.height / 2);
        storage_.push_back(halved(from, width, height, kind));
        levels_.push_back({width, height, storage_.back().data()});
    }
}

TextureSampler::TextureSampler(MipChain const& chain, Texture const& texture, TextureUse const& use)
    : chain_(&chain), decode_(chain.kind() == TexelKind::linear ? tables.linear.data() : tables.srgb.data()),
      wrap_u_(texture.wrap_u), wrap_v_(texture.wrap_v), nearest_(texture.nearest), uv_set_(use.uv_set),
      offset_(use.offset) {
    // KHR_texture_transform: counter-clockwise as seen, where v points down.
    float const c = std::cos(use.rotation);
    float const s = std::sin(use.rotation);
    column_u_ = Vec2(c, -s) * use.scale.x;
    column_v_ = Vec2(s, c) * use.scale.y;
}

bool TextureSampler::same_lookup(TextureSampler const& other) const {
    return chain_ == other.chain_ && wrap_u_ == other.wrap_u_ && wrap_v_ == other.wrap_v_ &&
           nearest_ == other.nearest_ && uv_set_ == other.uv_set_ && offset_ == other.offset_ &&
           column_u_ == other.column_u_ && column_v_ == other.column_v_;
}

Vec4 TextureSampler::bilinear(MipChain::Level const& level, Vec2 uv) const {
    Pair const x = texel_pair(uv.x, level.width, wrap_u_);
    Pair const y = texel_pair(uv.y, level.height, wrap_v_);
    std::size_t const stride = static_cast<std::size_t>(level.width) * 4;
    std::uint8_t const* top = level.rgba + static_cast<std::size_t>(y.first) * stride;
    std::uint8_t const* bottom = level.rgba + static_cast<std::size_t>(y.second) * stride;
    auto decoded = [this](std::uint8_t const* row, int column) {
        std::uint8_t const* texel = row + static_cast<std::size_t>(column) * 4;
        return Vec4(decode_[texel[0]], decode_[texel[1]], decode_[texel[2]], tables.linear[texel[3]]);
    };
    Vec4 const a = decoded(top, x.first), b = decoded(top, x.second);
    Vec4 const c = decoded(bottom, x.first), d = decoded(bottom, x.second);
    Vec4 const upper = a + (b - a) * x.weight;
    Vec4 const lower = c + (d - c) * x.weight;
    return upper + (lower - upper) * y.weight;
}

Vec4 TextureSampler::sample(Vec2 uv, UvFootprint const& footprint) const {
    MipChain::Level const& base = chain_->level(0);
    Vec2 const size(base.width, base.height);
    Vec2 const position = transformed(uv);
    Vec2 const major = column_u_ * footprint.major.x + column_v_ * footprint.major.y;
    Vec2 const minor = column_u_ * footprint.minor.x + column_v_ * footprint.minor.y;
    float const squared_a = glm::dot(major * size, major * size);
    float const squared_b = glm::dot(minor * size, minor * size);
    float const squared_long = std::max(squared_a, squared_b);
    if (!(squared_long > 1)) { // magnified
        if (nearest_) {
            Vec2 const whole(std::floor(position.x * size.x), std::floor(position.y * size.y));
            return bilinear(base, (whole + 0.5f) / size);
        }
        return bilinear(base, position);
    }
    if (!(squared_long < 1e12f)) { // covers all of the picture, and more than can be reckoned with
        return bilinear(chain_->level(chain_->levels() - 1), position);
    }
    float const length = std::sqrt(squared_long);
    float const width = std::max(std::sqrt(std::min(squared_a, squared_b)), 1.0f);
    int const taps = static_cast<int>(std::clamp(length / width + 0.5f, 1.0f, static_cast<float>(max_taps)));
    float const texels = std::max(width, length / static_cast<float>(taps)); // that one tap must average
    float const lod = std::min(std::log2(texels), static_cast<float>(chain_->levels() - 1));
    int const fine = static_cast<int>(lod);
    // Between levels only the middle half of the way is blended: half of the look-ups touch one level.
    float const blend = std::clamp(2 * (lod - static_cast<float>(fine)) - 0.5f, 0.0f, 1.0f);
    Vec2 const axis = squared_a >= squared_b ? major : minor;
    Vec4 sum(0);
    for (int i = 0; i < taps; ++i) {
        Vec2 const at = position + axis * ((static_cast<float>(i) + 0.5f) / static_cast<float>(taps) - 0.5f);
        Vec4 value(0);
        if (blend < 1) {
            value += bilinear(chain_->level(fine), at) * (1 - blend);
        }
        if (blend > 0) {
            value += bilinear(chain_->level(std::min(fine + 1, chain_->levels() - 1)), at) * blend;
        }
        sum += value;
    }
    return sum / static_cast<float>(taps);
}

float TextureSampler::alpha(Vec2 uv) const {
    MipChain::Level const& level = chain_->level(0);
    Vec2 const position = transformed(uv);
    Pair const x = texel_pair(position.x, level.width, wrap_u_);
    Pair const y = texel_pair(position.y, level.height, wrap_v_);
    auto at = [&](int column, int row) {
        return tables.linear[level.rgba[(static_cast<std::size_t>(row) * static_cast<std::size_t>(level.width) +
                                         static_cast<std::size_t>(column)) *
                                            4 +
                                        3]];
    };
    if (nearest_) {
        return at(x.weight < 0.5f ? x.first : x.second, y.weight < 0.5f ? y.first : y.second);
    }
    float const upper = at(x.first, y.first) + (at(x.second, y.first) - at(x.first, y.first)) * x.weight;
    float const lower = at(x.first, y.second) + (at(x.second, y.second) - at(x.first, y.second)) * x.weight;
    return upper + (lower - upper) * y.weight;
}

} // namespace framelet
