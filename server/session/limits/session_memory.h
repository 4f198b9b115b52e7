// Bounds how much memory the viewers' pictures may take together. In: sizes of pictures, as viewers ask for them. Out:
// whether there is room for them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "common/camera.h"

namespace framelet {

/// Most bytes of batches that a viewer has not answered which are kept for when it comes back: more than
/// `most_in_flight`, so that all are.
inline constexpr std::size_t most_kept_bytes = std::size_t{16} << 20;

/// Bytes that the server keeps for one viewer, at most: what it knows of its picture, what the viewer holds, batches
/// that are being made, and those without an answer. `predicts`: whether framelets are predicted.
std::size_t session_bytes(Viewport viewport, bool predicts);

class SessionMemory {
public:
    /// `budget`: bytes, for all sessions. `more_per_pixel`: bytes of a pixel besides `session_bytes`.
    explicit SessionMemory(std::size_t budget, std::size_t more_per_pixel = 0)
        : budget_(budget), more_per_pixel_(more_per_pixel) {}

    /// From now on pixels take so much besides.
    void set_more_per_pixel(std::size_t bytes) { more_per_pixel_ = bytes; }
    /// Sets aside what the session takes with a picture of this size, or says in one line why not. What it has from a
    /// larger picture stays its own until it ends: memory is used again rather than given back.
    std::optional<std::string> reserve(std::uint64_t session, Viewport viewport, bool predicts);
    /// Gives back what the session has, if it has any.
    void release(std::uint64_t session);
    /// Passes what session `from` has on to session `to`, which has nothing yet.
    void pass(std::uint64_t from, std::uint64_t to);

private:
    std::size_t const budget_;
    std::size_t more_per_pixel_;
    std::size_t reserved_ = 0;
    std::map<std::uint64_t, std::size_t> sessions_;
};

} // namespace framelet
