// Mixes two pictures of the same view to one that lies between them. In: both, a weight. Out: bytes of the mixed
// picture.
#pragma once

#include <cstdint>
#include <span>

#include "common/framelet/tile.h"
#include "common/image.h"

namespace framelet {

/// Share of the second picture in 256ths: 0 is the first one alone, `whole_share` the second one alone.
using MixShare = std::int32_t;
inline constexpr MixShare whole_share = 256;

/// The nearest share to `amount`, which is clamped to [0, 1].
MixShare mix_share(double amount);

/// A picture, and where it shows something. `inverse_depth` is as `Reprojector` keeps it; empty: it has no holes.
struct MixSource {
    Picture const& picture;
    std::span<float const> inverse_depth;
};

/// Writes the pixels of `rect` to `mixed`; all pictures are of one size, `rect` lies within it. Squares of values,
/// which are nearly linear light, are mixed and rounded to the nearest: the result is never outside of the two values,
/// and where they are equal it is that value. Where one picture only fills a hole, the other one shows. False, with
/// `mixed` written all the same, where both pictures are equal.
bool mix_pictures(MixSource const& first, MixSource const& second, MixShare share, PixelRect const& rect,
                  Picture& mixed);

/// Copies the pixels of `rect`.
void copy_pixels(Picture const& from, PixelRect const& rect, Picture& to);

} // namespace framelet
