// JPEG by libjpeg-turbo, and the choice of its quality for a link. In: a picture. Out: bytes, and back.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "common/image.h"

namespace framelet::bench {

class JpegCodec {
public:
    JpegCodec();
    ~JpegCodec();

    /// `quality` 1..100; colour at half resolution below 85, whole from there on. The bytes are valid until the next
    /// call.
    std::span<std::byte const> encode(Picture const& picture, int quality);
    /// `out` takes the picture's size. Throws InputError for damaged bytes.
    void decode(std::span<std::byte const> bytes, Picture& out);

private:
    struct Handles;
    std::unique_ptr<Handles> handles_;
};

/// Picks each frame's quality so that it fits a budget of bytes: fast down, slowly up.
class JpegRate {
public:
    static constexpr int worst = 10, best = 95;

    /// For the next frame. `budget`: bytes; infinite: unlimited.
    int quality(double budget) const;
    /// What a frame took.
    void took(int quality, std::size_t bytes);

private:
    double best_bytes_ = 0; ///< estimate of what the best quality would take; 0: nothing is known yet
    int last_ = 75;
};

} // namespace framelet::bench
