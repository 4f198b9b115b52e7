#include "common/spare_pool.h"

#include <algorithm>

namespace framelet {

namespace {

bool is_newer(Spare const& a, Spare const& b) {
    return a.batch != b.batch ? a.batch > b.batch : a.tile.code > b.tile.code;
}

} // namespace

SparePool::SparePool(std::size_t most) : most_(most) {
    spares_.reserve(most + 1);
}

std::optional<Spare> SparePool::add(Spare const& spare) {
    spares_.push_back(spare);
    std::push_heap(spares_.begin(), spares_.end(), is_newer);
    if (spares_.size() <= most_) {
        return std::nullopt;
    }
    std::pop_heap(spares_.begin(), spares_.end(), is_newer);
    Spare const oldest = spares_.back();
    spares_.pop_back();
    return oldest;
}

} // namespace framelet
