// Decodes bodies of messages. Input: one body.
#include "common/error.h"
#include "protocol/messages/message.h"
#include "protocol/messages/message_codec.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    using namespace framelet;
    try {
        Message const message = decode_message({reinterpret_cast<std::byte const*>(data), size});
        // A message that was taken is in range, and so can be written.
        encode_message(message);
    } catch (ProtocolError const&) {
    }
    return 0;
}
