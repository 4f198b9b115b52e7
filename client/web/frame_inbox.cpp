#include "client/web/frame_inbox.h"

#include <cstring>

#include "common/error.h"
#include "protocol/stream/message_frame.h"

namespace framelet {

void FrameInbox::add(ByteView bytes) {
    bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(begin_));
    begin_ = 0;
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

std::optional<ByteView> FrameInbox::next() {
    FramePrefix prefix;
    ByteView const rest = ByteView(bytes_).subspan(begin_);
    if (rest.size() < prefix.size()) {
        return std::nullopt;
    }
    std::memcpy(prefix.data(), rest.data(), prefix.size());
    std::size_t const size = body_size(prefix);
    if (size > most_bytes_) {
        throw ProtocolError("a message that is too long");
    }
    if (rest.size() - prefix.size() < size) {
        return std::nullopt;
    }
    begin_ += prefix.size() + size;
    return rest.subspan(prefix.size(), size);
}

} // namespace framelet
