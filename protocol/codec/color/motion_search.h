// Where in the picture that the viewer holds a framelet has been seen before. In: the picture, a framelet. Out: the
// vector from its tile to there. Only a writer needs it.
#pragma once

#include <array>

#include "protocol/codec/color/reference_picture.h"

namespace framelet {

/// Remembers what it has found: framelets near each other move alike.
class MotionSearch {
public:
    /// Forgets.
    void begin() { *this = {}; }
    /// The best vector of those tried: what was found before and steps from there, down to half a pixel, of coarse
    /// framelets two. Zero where the picture is not kept for searches.
    MotionVector find(ReferencePicture const& reference, DisplayFramelet const& framelet);

    /// Whether the last framelet for which this was noted was best predicted from elsewhere.
    bool has_moved() const { return has_moved_; }
    void note_moved(bool has_moved) { has_moved_ = has_moved; }

private:
    std::array<MotionVector, 6> found_{}; ///< lately, different ones
    std::size_t next_ = 0;
    bool has_moved_ = false;
};

} // namespace framelet
