// Samples and shapes of a batch to bytes and back: groups of framelets, each in planes of its own, and zstd.
#pragma once

#include <memory>

#include "common/framelet/framelet.h"
#include "protocol/codec/color/held_picture.h"
#include "protocol/messages/message.h"

namespace framelet {

/// Reusable scratch of the encoder and the decoder; the steady state allocates nothing that the result does not need.
class BatchCodec {
public:
    BatchCodec();
    ~BatchCodec();
    BatchCodec(BatchCodec&&) noexcept;
    BatchCodec& operator=(BatchCodec&&) noexcept;

    /// Without loss where the batch has no qualities; else each framelet with its own, and `decode` gives what the
    /// viewer will see. Shapes always lose a little (`shape_quantisation.h`). `held`: what the viewer holds after all
    /// batches before this one, from which it is predicted; it then holds this one as well. Null: the batch is coded
    /// alone.
    EncodedBatch encode(Batch const& batch, HeldPicture* held = nullptr);
    /// `held`: as it was for the encoder; null: a batch that is predicted is refused. Throws ProtocolError where
    /// payload and shapes are not exactly what the tiles ask for.
    Batch decode(EncodedBatch const& encoded, HeldPicture* held = nullptr);
    /// The same, into the memory of a batch that was decoded before, which grows to what the largest one needs. What is
    /// in it after an error says nothing.
    void decode(EncodedBatch const& encoded, HeldPicture* held, Batch& batch);

private:
    struct Scratch;

    Bytes encode_shapes(Batch const& batch);
    void decode_shapes(EncodedBatch const& encoded, std::vector<FrameletShape>& shapes);

    std::unique_ptr<Scratch> scratch_;
};

} // namespace framelet
