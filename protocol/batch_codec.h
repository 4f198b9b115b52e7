// Samples of a batch to bytes and back: planes, left difference, zstd. Encoder and decoder of one thing in one file.
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

    EncodedBatch encode(Batch const& batch);
    /// Throws ProtocolError where the payload is not exactly what the tiles ask for.
    Batch decode(EncodedBatch const& encoded);

private:
    struct Scratch;
    std::unique_ptr<Scratch> scratch_;
};

} // namespace framelet
