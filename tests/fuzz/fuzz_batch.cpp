// Decodes payloads of batches. Input: two bytes, the number of tiles; one byte, the encoding; the payload.
#include <array>

#include "common/error.h"
#include "protocol/codec/batch_codec.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    using namespace framelet;
    constexpr std::size_t head = 3;
    if (size < head) {
        return 0;
    }
    static BatchCodec codec;
    EncodedBatch encoded;
    encoded.number = 1;
    encoded.tiles.resize((data[0] | std::size_t{data[1]} << 8) % 1024);
    constexpr std::array encodings{SampleEncoding::exact, SampleEncoding::haar, SampleEncoding::predicted};
    encoded.encoding = encodings[data[2] % encodings.size()];
    BatchMemory memory;
    encoded.moment->view.viewport = {640, 480};
    for (std::uint32_t i = 0; i < encoded.tiles.size(); ++i) {
        encoded.tiles[i] = make_tile(6, i % 32, i / 32 % 30);
    }
    auto const* const payload = reinterpret_cast<std::byte const*>(data + head);
    encoded.payload.assign(payload, payload + (size - head));
    try {
        Batch const batch = codec.decode(encoded, &memory);
        FRAMELET_CHECK(batch.framelets.size() == encoded.tiles.size());
        // A batch that was taken can be sent again.
        codec.encode(batch, &memory);
    } catch (ProtocolError const&) {
    }
    return 0;
}
