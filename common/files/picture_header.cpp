#include "common/files/picture_header.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>
#include <utility>

namespace framelet {
namespace {

using namespace std::string_view_literals;
using Bytes = std::span<std::byte const>;

std::string_view text_of(Bytes bytes) {
    return {reinterpret_cast<char const*>(bytes.data()), bytes.size()};
}

/// The number of `count` bytes at `at`, least significant first; 0 beyond the end.
std::int64_t little(Bytes bytes, std::size_t at, std::size_t count) {
    std::int64_t value = 0;
    for (std::size_t i = 0; i < count && at + i < bytes.size(); ++i) {
        value |= std::to_integer<std::int64_t>(bytes[at + i]) << (8 * i);
    }
    return value;
}

std::int64_t big(Bytes bytes, std::size_t at) {
    return little(bytes, at, 1) << 8 | little(bytes, at + 1, 1);
}

constexpr std::size_t tga_header_bytes = 18;

bool may_be_tga(Bytes bytes) {
    if (bytes.size() < tga_header_bytes) {
        return false;
    }
    auto const is_one_of = [](std::int64_t value, auto... known) { return ((value == known) || ...); };
    std::int64_t const has_palette = little(bytes, 1, 1), type = little(bytes, 2, 1);
    return is_one_of(has_palette, 0, 1) && is_one_of(type, 1, 2, 3, 9, 10, 11) &&
           is_one_of(little(bytes, 16, 1), 8, 15, 16, 24, 32) && (has_palette == 1 || !is_one_of(type, 1, 9));
}

struct JpegFrame {
    PictureSize size;
    std::int64_t components = 0;
    bool is_progressive = false;
    std::int64_t first_scan_components = 0; ///< 0: there is no scan
};

/// A JPEG file is a row of segments, among them a frame header and the headers of scans.
std::optional<JpegFrame> jpeg_frame(Bytes bytes) {
    std::optional<JpegFrame> frame;
    for (std::size_t at = 2; at + 5 <= bytes.size();) {
        std::int64_t const marker = little(bytes, at + 1, 1);
        if (bytes[at] != std::byte{0xff} || marker == 0xff) {
            ++at; // between segments, where libjpeg passes over what is there
            continue;
        }
        bool const is_frame = marker >= 0xc0 && marker <= 0xcf && marker != 0xc4 && marker != 0xc8 && marker != 0xcc;
        if (is_frame && !frame && at + 9 <= bytes.size()) {
            frame = JpegFrame{{big(bytes, at + 7), big(bytes, at + 5)}, little(bytes, at + 9, 1), (marker & 3) == 2, 0};
        } else if (marker == 0xda && frame) {
            frame->first_scan_components = little(bytes, at + 4, 1);
            break;
        }
        bool const is_alone = marker <= 0x01 || (marker >= 0xd0 && marker <= 0xd8);
        at += 2 + (is_alone ? 0 : static_cast<std::size_t>(big(bytes, at + 2)));
    }
    return frame;
}

/// The first chunk has the size: of the canvas, or of the only frame, with or without loss.
std::optional<PictureSize> webp_size(Bytes bytes) {
    constexpr std::size_t content = 20;
    if (bytes.size() < content + 10) {
        return std::nullopt;
    }
    std::string_view const chunk = text_of(bytes).substr(12, 4);
    if (chunk == "VP8X") {
        return PictureSize{1 + little(bytes, content + 4, 3), 1 + little(bytes, content + 7, 3)};
    }
    if (chunk == "VP8L") {
        std::int64_t const bits = little(bytes, content + 1, 4);
        return PictureSize{1 + (bits & 0x3fff), 1 + (bits >> 14 & 0x3fff)};
    }
    if (chunk == "VP8 ") {
        return PictureSize{little(bytes, content + 6, 2) & 0x3fff, little(bytes, content + 8, 2) & 0x3fff};
    }
    return std::nullopt;
}

std::optional<PictureSize> bmp_size(Bytes bytes) {
    if (bytes.size() < 26) {
        return std::nullopt;
    }
    bool const is_first_version = little(bytes, 14, 4) == 12;
    if (is_first_version) {
        return PictureSize{little(bytes, 18, 2), little(bytes, 20, 2)};
    }
    auto const side = [&](std::size_t at) {
        // A negative height says that rows go down.
        return std::abs(std::int64_t{static_cast<std::int32_t>(little(bytes, at, 4))});
    };
    return PictureSize{side(18), side(22)};
}

} // namespace

std::optional<PictureFormat> picture_format(Bytes bytes) {
    constexpr std::pair<std::string_view, PictureFormat> signatures[] = {{"\x89PNG\r\n\x1a\n"sv, PictureFormat::png},
                                                                         {"\xff\xd8\xff"sv, PictureFormat::jpeg},
                                                                         {"BM"sv, PictureFormat::bmp},
                                                                         {"P5"sv, PictureFormat::pnm},
                                                                         {"P6"sv, PictureFormat::pnm},
                                                                         {"#?RADIANCE"sv, PictureFormat::hdr},
                                                                         {"#?RGBE"sv, PictureFormat::hdr},
                                                                         {"\x76\x2f\x31\x01"sv, PictureFormat::exr}};
    std::string_view const text = text_of(bytes);
    for (auto const& [signature, format] : signatures) {
        if (text.starts_with(signature)) {
            return format;
        }
    }
    if (text.starts_with("RIFF") && text.substr(0, 12).ends_with("WEBP")) {
        return PictureFormat::webp;
    }
    return foreign_format(bytes) == nullptr && may_be_tga(bytes) ? std::optional(PictureFormat::tga) : std::nullopt;
}

char const* foreign_format(Bytes bytes) {
    constexpr std::pair<std::string_view, char const*> signatures[] = {
        {"\xabKTX 20"sv, "KTX2"}, {"\xabKTX 11"sv, "KTX"}, {"sB"sv, "Basis Universal"},
        {"GIF8"sv, "GIF"},        {"DDS "sv, "DDS"},       {"II*\0"sv, "TIFF"},
        {"MM\0*"sv, "TIFF"},      {"8BPS"sv, "PSD"},       {"\0\0\0\x0cjP  "sv, "JPEG 2000"},
        {"gimp xcf"sv, "XCF"},    {"\0\0\x01\0"sv, "icon"}};
    std::string_view const text = text_of(bytes);
    auto const* const found = std::find_if(std::begin(signatures), std::end(signatures),
                                           [&](auto const& entry) { return text.starts_with(entry.first); });
    return found == std::end(signatures) ? nullptr : found->second;
}

std::optional<PictureSize> header_size(PictureFormat format, Bytes bytes) {
    switch (format) {
    case PictureFormat::jpeg: {
        auto const frame = jpeg_frame(bytes);
        return frame ? std::optional(frame->size) : std::nullopt;
    }
    case PictureFormat::webp:
        return webp_size(bytes);
    case PictureFormat::bmp:
        return bmp_size(bytes);
    case PictureFormat::tga:
        return bytes.size() < tga_header_bytes ? std::nullopt
                                               : std::optional(PictureSize{little(bytes, 12, 2), little(bytes, 14, 2)});
    default:
        return std::nullopt;
    }
}

std::uint64_t bytes_beside(Bytes bytes) {
    auto const frame = picture_format(bytes) == PictureFormat::jpeg ? jpeg_frame(bytes) : std::nullopt;
    if (!frame || (!frame->is_progressive && frame->first_scan_components >= frame->components)) {
        return 0;
    }
    auto const whole_blocks = [](std::int64_t side) { return static_cast<std::uint64_t>((side + 31) / 32 * 32); };
    constexpr std::uint64_t coefficient_bytes = 2;
    return whole_blocks(frame->size.width) * whole_blocks(frame->size.height) *
           static_cast<std::uint64_t>(frame->components) * coefficient_bytes;
}

} // namespace framelet
