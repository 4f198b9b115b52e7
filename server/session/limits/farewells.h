// The connections that have ended and are still told why, which takes a second at most. In: streams that end. However
// fast they come, no more of them than that stay open.
#pragma once

#include <cstddef>
#include <deque>
#include <memory>

#include "protocol/stream/framed_stream.h"

namespace framelet {

class Farewells {
public:
    static constexpr std::size_t most = 64;

    /// Closes the oldest where it would be one too many.
    void add(std::shared_ptr<FramedStream> const& stream) {
        std::erase_if(ending_, [](auto const& other) { return other.expired(); });
        ending_.push_back(stream);
        if (ending_.size() > most) {
            if (auto const oldest = ending_.front().lock()) {
                oldest->close();
            }
            ending_.pop_front();
        }
    }

private:
    std::deque<std::weak_ptr<FramedStream>> ending_; ///< a stream lives on by itself until it is closed
};

} // namespace framelet
