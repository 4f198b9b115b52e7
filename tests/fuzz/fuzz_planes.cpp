// Groups of framelets behind the decompression, where damage is likelier to get far. Input: one byte, the number of
// framelets; one byte, odd where they are predicted; what a frame holds.
#include "common/error.h"
#include "protocol/codec/color/plane_codec.h"

namespace {

using namespace framelet;

constexpr Viewport viewport{200, 100};

/// Tiles of all depths.
std::vector<DisplayFramelet> framelets_of(std::size_t count) {
    ImagePlane const plane(viewport);
    std::vector<DisplayFramelet> framelets;
    for (std::uint32_t code = 1; framelets.size() < count; code = code * 5 % 4096 + 1) {
        if (plane.accepts({code})) {
            framelets.emplace_back().tile = {code};
        }
    }
    return framelets;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    constexpr std::size_t head = 2;
    if (size < head) {
        return 0;
    }
    static PlaneCodec codec;
    static HeldPicture picture;
    picture.show(viewport);
    picture.prepare_search({});
    HeldPicture* const held = data[1] % 2 == 0 ? nullptr : &picture;
    std::vector<DisplayFramelet> framelets = framelets_of(data[0] % 129u);
    std::vector<std::uint8_t> quality(framelets.size());
    try {
        codec.decode({data + head, size - head}, framelets, quality, held);
    } catch (ProtocolError const&) {
        return 0;
    }
    // What was taken can be sent again, and arrives as its writer says.
    std::vector<DisplayFramelet> said = framelets, arrived = framelets;
    std::vector<std::uint8_t> bytes;
    for (auto const part : codec.encode(framelets, quality, held, said)) {
        bytes.insert(bytes.end(), part.begin(), part.end());
    }
    codec.decode(bytes, arrived, quality, held);
    FRAMELET_CHECK(held == nullptr || arrived == said);
    picture.take(arrived);
    return 0;
}
