// Motion search: finds where in the reference picture a framelet has been seen before. In: the picture, a framelet.
// Out: the motion vector from its tile to there. Only a writer needs it.
#pragma once

#include <array>

#include "protocol/codec/color/reference_picture.h"

namespace framelet {

/// Searches for motion vectors, and remembers those that it has found: framelets near each other move alike.
class MotionSearch {
public:
    /// Forgets all vectors, and what was noted.
    void begin() { *this = {}; }
    /// Finds the best vector of those tried: the ones found before, and steps from the best of them, down to half a
    /// pixel, or two pixels for coarse framelets. Returns zero where the picture is not kept for searches.
    MotionVector find(ReferencePicture const& reference, DisplayFramelet const& framelet);

    /// True where the last framelet for which this was noted was best predicted from elsewhere.
    bool has_moved() const { return has_moved_; }
    void note_moved(bool has_moved) { has_moved_ = has_moved; }

private:
    std::array<MotionVector, 6> found_{}; ///< the last ones found, all different
    std::size_t next_ = 0;
    bool has_moved_ = false;
};

} // namespace framelet
