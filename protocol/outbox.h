// Frames on their way to a socket. In: whole frames. Out: what the socket has to take next, and how many bytes it has
// not taken yet, a number that any thread may ask for.
#pragma once

#include <atomic>
#include <cstddef>
#include <deque>
#include <utility>

#include "protocol/message.h"

namespace framelet {

/// Bytes are announced by the thread that sends them and pushed by the socket's thread; all but `announce` and `unsent`
/// is for the latter.
class Outbox {
public:
    void announce(std::size_t bytes) { unsent_ += bytes; }
    std::size_t unsent() const { return unsent_; }

    /// A frame that was announced: to be sent, or not any more.
    void push(Bytes frame) { frames_.push_back(std::move(frame)); }
    void refuse(Bytes const& frame) { unsent_ -= frame.size(); }

    bool empty() const { return frames_.empty(); }
    /// Not yet taken of the first frame. Stays where it is until `took` or `release`.
    ByteView rest() const { return ByteView(frames_.front()).subspan(taken_); }

    /// The socket took so many bytes of `rest`. Returns the frame's size if it was the last of them, otherwise 0.
    std::size_t took(std::size_t bytes) {
        unsent_ -= bytes;
        taken_ += bytes;
        std::size_t const size = frames_.front().size();
        if (taken_ < size) {
            return 0;
        }
        frames_.pop_front();
        taken_ = 0;
        return size;
    }

    /// Nothing more will be taken; the memory stays until `release`, because the socket may still refer to it.
    void abandon() {
        for (Bytes const& frame : frames_) {
            unsent_ -= frame.size();
        }
        unsent_ += std::exchange(taken_, 0);
    }
    void release() { frames_.clear(); }

private:
    std::deque<Bytes> frames_;
    std::size_t taken_ = 0; ///< of the first frame
    std::atomic<std::size_t> unsent_ = 0;
};

} // namespace framelet
