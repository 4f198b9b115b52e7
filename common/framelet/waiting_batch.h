// A batch that waits to be shown: what of it is kept, and the memory that this takes. In: batches. Out: copies, bytes.
#pragma once

#include <cstddef>

#include "common/framelet/framelet.h"

namespace framelet {

/// A copy without the tracks, for after these have been taken in: they may be long where there is no framelet at all.
inline Batch without_tracks(Batch const& batch) {
    return {batch.number,   batch.view,      batch.scene_time, batch.shown_from,
            batch.outdates, batch.framelets, batch.qp,         batch.shapes};
}

/// The memory that a batch takes, about; of one without framelets too.
inline std::size_t bytes_of(Batch const& batch) {
    std::size_t bytes = sizeof batch + batch.framelets.size() * sizeof(DisplayFramelet);
    for (FrameletShape const& shape : batch.shapes) {
        bytes += sizeof shape + shape.outliers.size() * sizeof shape.outliers[0];
    }
    for (BodyTrack const& track : batch.tracks) {
        bytes += sizeof track + track.keys.size() * sizeof(BodyPose);
    }
    return bytes + (batch.camera_track ? batch.camera_track->keys.size() * sizeof(BodyPose) : 0);
}

} // namespace framelet
