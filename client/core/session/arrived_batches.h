// Batches that have been decoded and wait for the next picture, and the memory of those that are in it already. In:
// batches one by one. Out: all that wait. A value.
#pragma once

#include <cstddef>
#include <vector>

#include "common/framelet/framelet.h"

namespace framelet {

class ArrivedBatches {
public:
    /// The largest number of bytes that may wait for a painter that is busy, or for a window that is hidden.
    static constexpr std::size_t most_bytes = 256u << 20;
    /// The largest number of batches whose memory is kept.
    static constexpr std::size_t most_spares = 4;

    void add(Batch batch);
    bool empty() const { return waiting_.empty(); }
    std::size_t bytes() const { return bytes_; } ///< of those that wait
    bool is_full() const { return bytes_ > most_bytes; }
    void clear();
    /// Moves all batches that wait to `out`, in order; `out` is empty before.
    void take(std::vector<Batch>& out);

    /// A batch to decode into, with whatever is left in it.
    Batch take_spare();
    /// Takes batches back for the sake of their memory; empties `used`.
    void give_back(std::vector<Batch>& used);

private:
    std::vector<Batch> waiting_, spares_;
    std::size_t bytes_ = 0;
};

} // namespace framelet
