// Groups of framelets behind the decompression, where damage is likelier to get far. Input: one byte, the number of
// framelets; what a frame holds.
#include "common/error.h"
#include "protocol/plane_codec.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    using namespace framelet;
    if (size < 1) {
        return 0;
    }
    static PlaneCodec codec;
    std::vector<DisplayFramelet> framelets(data[0] % 129u);
    std::vector<std::uint8_t> quality(framelets.size());
    try {
        codec.decode({data + 1, size - 1}, framelets, quality);
        codec.encode(framelets, quality);
    } catch (ProtocolError const&) {
    }
    return 0;
}
