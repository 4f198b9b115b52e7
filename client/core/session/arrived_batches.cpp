#include "client/core/session/arrived_batches.h"

#include <utility>

#include "common/framelet/waiting_batch.h"

namespace framelet {

void ArrivedBatches::add(Batch batch) {
    bytes_ += bytes_of(batch);
    waiting_.push_back(std::move(batch));
}

void ArrivedBatches::clear() {
    waiting_.clear();
    bytes_ = 0;
}

void ArrivedBatches::take(std::vector<Batch>& out) {
    out.swap(waiting_);
    bytes_ = 0;
}

Batch ArrivedBatches::take_spare() {
    Batch batch;
    if (!spares_.empty()) {
        batch = std::move(spares_.back());
        spares_.pop_back();
    }
    return batch;
}

void ArrivedBatches::give_back(std::vector<Batch>& used) {
    while (!used.empty() && spares_.size() < most_spares) {
        spares_.push_back(std::move(used.back()));
        used.pop_back();
    }
    used.clear();
}

} // namespace framelet
