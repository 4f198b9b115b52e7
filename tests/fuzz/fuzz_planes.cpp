// Decodes a group of framelets. Input: one byte, the number of framelets; one byte, odd where they are predicted; a
// frame.
#include "common/error.h"
#include "protocol/codec/color/plane_codec.h"

namespace {

using namespace framelet;

constexpr Viewport viewport{200, 100};

/// Framelets whose tiles are of all depths.
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
    static ReferencePicture picture;
    picture.show(viewport);
    picture.prepare_search({});
    ReferencePicture* const held = data[1] % 2 == 0 ? nullptr : &picture;
    std::vector<DisplayFramelet> framelets = framelets_of(data[0] % 129u);
    std::vector<std::uint8_t> qp(framelets.size());
    PlaneModel reader; // new for each input: an input that fails does so alone
    try {
        PlaneCodec::decode({data + head, size - head}, framelets, qp, reader, held);
    } catch (ProtocolError const&) {
        return 0;
    }
    // Framelets that were taken can be sent again, and arrive as their writer says; the second time with what the first
    // has taught.
    PlaneModel writer;
    reader = {};
    std::vector<DisplayFramelet> said = framelets, arrived = framelets;
    for (int round = 0; round < 2; ++round) {
        std::vector<std::uint8_t> arrived_qp(qp.size());
        PlaneCodec::decode(codec.encode(framelets, qp, writer, held, said), arrived, arrived_qp, reader, held);
        FRAMELET_CHECK(arrived_qp == qp);
        FRAMELET_CHECK(held == nullptr || arrived == said);
        for (std::size_t i = 0; i < framelets.size(); ++i) {
            FRAMELET_CHECK(qp[i] != lossless_qp || arrived[i] == framelets[i]);
        }
    }
    picture.take(arrived);
    return 0;
}
