// Does what a viewer does with the messages of a server, one after the other: batches into the memory that later ones
// are decoded with, and into the cache. Input: bodies of messages, each with its length, two bytes, in front.
#include <algorithm>

#include "common/error.h"
#include "common/held/framelet_cache.h"
#include "protocol/codec/batch_codec.h"
#include "protocol/messages/message_codec.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    using namespace framelet;
    static BatchCodec codec;
    FrameletCache cache{ImagePlane(Viewport{256, 256})};
    BatchMemory memory;
    try {
        while (size >= 2) {
            std::size_t const length = std::min(data[0] | std::size_t{data[1]} << 8, size - 2);
            Message const message = decode_message({reinterpret_cast<std::byte const*>(data + 2), length});
            data += 2 + length;
            size -= 2 + length;
            auto const* const encoded = std::get_if<EncodedBatch>(&message);
            // Another viewport is decoded all the same; the seeds' own is enough here, and small.
            if (encoded == nullptr || (encoded->moment && encoded->moment->view.viewport != cache.plane().viewport())) {
                continue;
            }
            Batch const batch = codec.decode(*encoded, &memory);
            FRAMELET_CHECK(cache.insert(batch) <= batch.framelets.size());
        }
    } catch (ProtocolError const&) {
    }
    return 0;
}
