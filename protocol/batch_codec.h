// Samples of a batch to bytes and back: groups of framelets, each in planes of its own, and zstd.
#pragma once

#include <memory>

#include "common/framelet.h"
#include "protocol/message.h"

namespace framelet {

/// Reusable scratch of the encoder and the decoder; the steady state allocates nothing that the result does not need.
class BatchCodec {
public:
    BatchCodec();
    ~BatchCodec();
    BatchCodec(BatchCodec&&) noexcept;
    BatchCodec& operator=(BatchCodec&&) noexcept;

    /// Without loss where the batch has no qualities; else each framelet with its own, and `decode` gives what the
    /// viewer will see.
    EncodedBatch encode(Batch const& batch);
    /// Throws ProtocolError where the payload is not exactly what the tiles ask for.
    Batch decode(EncodedBatch const& encoded);

private:
    struct Scratch;
    std::unique_ptr<Scratch> scratch_;
};

} // namespace framelet
