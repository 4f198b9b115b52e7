#include "tests/evaluation/codecs/jpeg_codec.h"

#include <algorithm>
#include <cmath>

#include <turbojpeg.h>

#include "common/error.h"

namespace framelet::bench {
namespace {

constexpr int whole_color_from = 85;
constexpr int largest_rise = 4;

/// Size of a frame of this quality beside one of the best: twice the quantisation step, some 0.6 of the bytes. The
/// scale of steps is libjpeg's (5000 / q below 50, 200 - 2 q above).
double relative_bytes(int quality) {
    double const scale = quality < 50 ? 5000.0 / quality : std::max(200.0 - 2 * quality, 1.0);
    double const best = 200.0 - 2 * JpegRate::best;
    return std::pow(scale / best, -0.7);
}

} // namespace

struct JpegCodec::Handles {
    tjhandle compressor = tjInitCompress();
    tjhandle decompressor = tjInitDecompress();
    unsigned char* bytes = nullptr;
    unsigned long capacity = 0;

    ~Handles() {
        tjFree(bytes);
        tjDestroy(compressor);
        tjDestroy(decompressor);
    }
};

JpegCodec::JpegCodec() : handles_(std::make_unique<Handles>()) {
    FRAMELET_CHECK(handles_->compressor && handles_->decompressor);
}

JpegCodec::~JpegCodec() = default;

std::span<std::byte const> JpegCodec::encode(Picture const& picture, int quality) {
    FRAMELET_CHECK(quality >= 1 && quality <= 100 && picture.width > 0 && picture.height > 0);
    int const subsampling = quality < whole_color_from ? TJSAMP_420 : TJSAMP_444;
    unsigned long size = handles_->capacity;
    int const failed = tjCompress2(handles_->compressor, picture.rgba.data(), picture.width, 0, picture.height,
                                   TJPF_RGBX, &handles_->bytes, &size, subsampling, quality, 0);
    FRAMELET_CHECK(failed == 0);
    handles_->capacity = std::max(handles_->capacity, size);
    return std::as_bytes(std::span(handles_->bytes, size));
}

void JpegCodec::decode(std::span<std::byte const> bytes, Picture& out) {
    auto const* const data = reinterpret_cast<unsigned char const*>(bytes.data());
    int width = 0, height = 0, subsampling = 0, colors = 0;
    tjhandle const handle = handles_->decompressor;
    if (tjDecompressHeader3(handle, data, bytes.size(), &width, &height, &subsampling, &colors) != 0) {
        throw InputError(std::string("JPEG: ") + tjGetErrorStr2(handle));
    }
    if (out.width != width || out.height != height) {
        out = Picture(width, height);
    }
    if (tjDecompress2(handle, data, bytes.size(), out.rgba.data(), width, 0, height, TJPF_RGBA, TJFLAG_STOPONWARNING) !=
        0) {
        throw InputError(std::string("JPEG: ") + tjGetErrorStr2(handle));
    }
}

int JpegRate::quality(double budget) const {
    if (!std::isfinite(budget)) {
        return best;
    }
    if (best_bytes_ <= 0) {
        return std::clamp(last_, worst, best);
    }
    int fitting = worst;
    for (int q = best; q > worst; --q) {
        if (best_bytes_ * relative_bytes(q) <= budget) {
            fitting = q;
            break;
        }
    }
    return std::min(fitting, last_ + largest_rise);
}

void JpegRate::took(int quality, std::size_t bytes) {
    last_ = quality;
    best_bytes_ = static_cast<double>(bytes) / relative_bytes(quality);
}

} // namespace framelet::bench
