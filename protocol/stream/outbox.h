// Frames on their way to a socket. In: whole frames. Out: what the socket has to take next, and how many bytes it has
// not taken yet, a number that any thread may ask for.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <deque>
#include <utility>

#include "protocol/messages/message.h"

namespace framelet {

/// Bytes are announced by the thread that sends them and pushed by the socket's thread; all but `announce` and `unsent`
/// is for the latter.
class Outbox {
public:
    void announce(std::size_t bytes) { unsent_ += bytes; }
    std::size_t unsent() const { return unsent_; }

    /// Takes a frame that was announced: to be sent, or not any more.
    void push(Bytes frame) { frames_.push_back({std::move(frame), false}); }
    void refuse(Bytes const& frame) { unsent_ -= frame.size(); }
    /// Takes a frame that says all that an earlier one said, only newer: of these the newest waits, in the place of the
    /// first, so that it comes through however often it is replaced.
    void push_newest(Bytes frame) {
        // The first of all frames may be with the socket already.
        auto const behind_first = frames_.begin() + (frames_.empty() ? 0 : 1);
        auto const older = std::find_if(behind_first, frames_.end(), [](Frame const& f) { return f.replaceable; });
        if (older == frames_.end()) {
            frames_.push_back({std::move(frame), true});
        } else {
            unsent_ -= older->bytes.size();
            older->bytes = std::move(frame);
        }
    }

    bool empty() const { return frames_.empty(); }
    /// Bytes of the first frame that the socket has not taken yet. They stay where they are until `took` or `release`.
    ByteView rest() const { return ByteView(frames_.front().bytes).subspan(taken_); }

    /// Notes that the socket took so many bytes of `rest`. Returns the frame's size if it was the last of them,
    /// otherwise 0.
    std::size_t took(std::size_t bytes) {
        unsent_ -= bytes;
        taken_ += bytes;
        std::size_t const size = frames_.front().bytes.size();
        if (taken_ < size) {
            return 0;
        }
        frames_.pop_front();
        taken_ = 0;
        return size;
    }

    /// Gives up all frames but the first, which the socket may have begun to take.
    void drop_waiting() {
        for (; frames_.size() > 1; frames_.pop_back()) {
            unsent_ -= frames_.back().bytes.size();
        }
    }

    /// Gives up all frames; the memory stays until `release`, because the socket may still refer to it.
    void abandon() {
        for (Frame const& frame : frames_) {
            unsent_ -= frame.bytes.size();
        }
        unsent_ += std::exchange(taken_, 0);
    }
    void release() { frames_.clear(); }

private:
    struct Frame {
        Bytes bytes;
        bool replaceable; ///< a newer one of its kind may take its place
    };

    std::deque<Frame> frames_;
    std::size_t taken_ = 0; ///< bytes taken of the first frame
    std::atomic<std::size_t> unsent_ = 0;
};

} // namespace framelet
