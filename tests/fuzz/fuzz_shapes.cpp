// Shapes of a group of framelets behind the decompression. Input: one byte, the number of framelets; what a frame
// holds.
#include "common/error.h"
#include "protocol/codec/geometry/shape_codec.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    using namespace framelet;
    if (size < 1) {
        return 0;
    }
    std::vector<FrameletShape> shapes(data[0] % 129u);
    std::vector<std::uint8_t> const side_bits(shapes.size(), 4);
    try {
        ShapeCodec::decode({data + 1, size - 1}, side_bits, shapes);
        ShapeCodec().encode(shapes, side_bits);
    } catch (ProtocolError const&) {
    }
    return 0;
}
