#include "common/warp/merging/square_layers.h"

#include <algorithm>
#include <cstring>

namespace framelet {

void SquareLayers::clear(std::size_t index) {
    for (Rows& rows : rows_) {
        rows.held &= ~(std::uint64_t{1} << index);
    }
}

bool SquareLayers::set(std::size_t index, std::uint32_t view, std::uint64_t batch, HeldShape const& shape) {
    clear(index);
    batches_[index] = batch;
    for (std::size_t k = 0; k < shape.layer_count; ++k) {
        HeldLayer const& held = shape.layers[k];
        if (held.last_column < held.first_column) {
            continue;
        }
        std::int32_t const motion = number_of({view, held.layer.body, held.layer.drift});
        if (motions_.size() > most_motions) {
            return false;
        }
        Rows& rows = rows_[k];
        rows.at[index] = held.layer.at;
        rows.dx[index] = held.layer.dx;
        rows.dy[index] = held.layer.dy;
        rows.error[index] = held.layer.error;
        // The box is four bytes one after the other.
        static_assert(offsetof(HeldLayer, last_row) == offsetof(HeldLayer, first_column) + 3);
        std::memcpy(&rows.box[index], &held.first_column, sizeof(std::int32_t));
        rows.motion[index] = motion;
        rows.held |= std::uint64_t{1} << index;
    }
    return true;
}

/// The number of a motion; mostly that of the one before.
std::int32_t SquareLayers::number_of(Motion const& motion) {
    if (last_motion_ < motions_.size() && motions_[last_motion_] == motion) {
        return static_cast<std::int32_t>(last_motion_);
    }
    last_motion_ = static_cast<std::size_t>(std::ranges::find(motions_, motion) - motions_.begin());
    if (last_motion_ == motions_.size()) {
        motions_.push_back(motion);
    }
    return static_cast<std::int32_t>(last_motion_);
}

} // namespace framelet
