// Textures: mip chains of 8-bit texels, looked up with a footprint. In: a picture as the file stores it and a pair of
// footprint axes in texture coordinates. Out: filtered linear values.
#pragma once

#include <memory>
#include <vector>

#include "common/image.h"
#include "server/scene/scene.h"

namespace framelet {

/// Meaning of a texture's bytes, which decides how they are averaged.
enum class TexelKind : std::uint8_t {
    color, ///< sRGB colour; alpha is ignored
    color_alpha, ///< sRGB colour of a surface that is partly there: averages weigh colour by alpha
    linear, ///< numbers
};

/// One picture in halving sizes, box-filtered in linear light. Level 0 is the scene's own picture, not a copy.
class MipChain {
public:
    MipChain(std::shared_ptr<Picture const> picture, TexelKind kind);

    struct Level {
        int width, height;
        std::uint8_t const* rgba;
    };

    int levels() const { return static_cast<int>(levels_.size()); }
    Level const& level(int index) const { return levels_[static_cast<std::size_t>(index)]; }
    TexelKind kind() const { return kind_; }

private:
    std::shared_ptr<Picture const> picture_;
    TexelKind kind_;
    std::vector<std::vector<std::uint8_t>> storage_;
    std::vector<Level> levels_;
};

/// The area that a sample covers in texture coordinates (of the untransformed uv set): an ellipse's two axes.
struct UvFootprint {
    Vec2 major{0, 0};
    Vec2 minor{0, 0};
};

/// A texture as one material uses it: picture, wrapping and KHR_texture_transform.
class TextureSampler {
public:
    TextureSampler() = default;
    TextureSampler(MipChain const& chain, Texture const& texture, TextureUse const& use);

    explicit operator bool() const { return chain_ != nullptr; }
    int uv_set() const { return uv_set_; }
    /// True when both look up the same texel for the same coordinates.
    bool same_lookup(TextureSampler const& other) const;

    /// Filtered value: colours decoded to linear light, numbers as 0..1; alpha in w. Trilinear, with up to four taps
    /// along the major axis where the footprint is elongated.
    Vec4 sample(Vec2 uv, UvFootprint const& footprint) const;
    /// Alpha alone, bilinear at full resolution: for tests of a single ray against a cut-out, which has no footprint.
    float alpha(Vec2 uv) const;

private:
    Vec2 transformed(Vec2 uv) const { return offset_ + column_u_ * uv.x + column_v_ * uv.y; }
    Vec4 bilinear(MipChain::Level const& level, Vec2 uv) const;

    MipChain const* chain_ = nullptr;
    float const* decode_ = nullptr; ///< byte to value for red, green and blue
    Wrap wrap_u_ = Wrap::repeat;
    Wrap wrap_v_ = Wrap::repeat;
    bool nearest_ = false;
    int uv_set_ = 0;
    Vec2 offset_{0, 0};
    Vec2 column_u_{1, 0};
    Vec2 column_v_{0, 1};
};

} // namespace framelet
