// Samples and shapes of a batch to bytes and back, in groups of framelets: without loss as planes and zstd, else, as
// the shapes, by a range coder.
#pragma once

#include <memory>
#include <optional>

#include "common/framelet/framelet.h"
#include "protocol/codec/color/reference_picture.h"
#include "protocol/messages/message.h"

namespace framelet {

struct BatchModels;

/// What both sides of a session know of the batches before, the same after each batch.
struct BatchMemory {
    BatchMemory();
    ~BatchMemory();
    BatchMemory(BatchMemory&&) noexcept;
    BatchMemory& operator=(BatchMemory&&) noexcept;

    std::optional<BatchMoment> moment; ///< of the newest batch
    ReferencePicture picture; ///< that the viewer holds
    std::unique_ptr<BatchModels> models; ///< how likely which decisions of the range coder are
};

/// Reusable scratch of the encoder and the decoder; the steady state allocates nothing that the result does not need.
class BatchCodec {
public:
    BatchCodec();
    ~BatchCodec();
    BatchCodec(BatchCodec&&) noexcept;
    BatchCodec& operator=(BatchCodec&&) noexcept;

    /// Without loss where the batch has no QPs; else each framelet with its own, and `decode` gives what the
    /// viewer will see. Shapes always lose a little (`shape_quantisation.h`). `memory`: of all batches before this one,
    /// which then knows this one as well; null: this batch stands alone. `predicts`: samples with loss are predicted
    /// from the picture in the memory.
    EncodedBatch encode(Batch const& batch, BatchMemory* memory = nullptr, bool predicts = true);
    /// `memory`: as it was for the encoder; null: a batch that is predicted is refused. Throws ProtocolError where
    /// payload and shapes are not exactly what the tiles ask for.
    Batch decode(EncodedBatch const& encoded, BatchMemory* memory = nullptr);
    /// The same, into the memory of a batch that was decoded before, which grows to what the largest one needs. What is
    /// in it after an error says nothing.
    void decode(EncodedBatch const& encoded, BatchMemory* memory, Batch& batch);

private:
    struct Scratch;

    Bytes encode_shapes(Batch const& batch, BatchModels& models);
    void decode_shapes(EncodedBatch const& encoded, ImagePlane const& plane, BatchModels& models,
                       std::vector<FrameletShape>& shapes);

    std::unique_ptr<Scratch> scratch_;
};

} // namespace framelet
