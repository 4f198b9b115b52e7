// Payloads of batches. Input: two bytes, the number of tiles; one byte, the encoding; the payload.
#include "common/error.h"
#include "protocol/batch_codec.h"

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
    encoded.encoding = data[2] % 2 == 0 ? SampleEncoding::exact : SampleEncoding::haar;
    auto const* const payload = reinterpret_cast<std::byte const*>(data + head);
    encoded.payload.assign(payload, payload + (size - head));
    try {
        Batch const batch = codec.decode(encoded);
        FRAMELET_CHECK(batch.framelets.size() == encoded.tiles.size());
        // What was taken can be sent again.
        codec.encode(batch);
    } catch (ProtocolError const&) {
    }
    return 0;
}
