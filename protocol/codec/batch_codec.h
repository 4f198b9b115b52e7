// Encodes samples, shapes and tracks of a batch to bytes and back, in groups of framelets: samples without loss as
// planes and zstd; samples with loss, and shapes, by a range coder.
#pragma once

#include <memory>
#include <optional>

#include "common/framelet/framelet.h"
#include "protocol/codec/color/reference_picture.h"
#include "protocol/messages/message.h"

namespace framelet {

struct BatchModels;

/// Memory of the earlier batches of a session, the same on both sides after each batch.
struct BatchMemory {
    BatchMemory();
    ~BatchMemory();
    BatchMemory(BatchMemory&&) noexcept;
    BatchMemory& operator=(BatchMemory&&) noexcept;

    std::optional<BatchMoment> moment; ///< that of the newest batch; none before the first
    ReferencePicture picture; ///< what the viewer holds, as far as framelets are predicted from it
    std::unique_ptr<BatchModels> models; ///< how likely each decision of the range coder is
};

/// Encodes and decodes batches, with scratch that is reused: in the steady state it allocates nothing that the result
/// does not need.
class BatchCodec {
public:
    BatchCodec();
    ~BatchCodec();
    BatchCodec(BatchCodec&&) noexcept;
    BatchCodec& operator=(BatchCodec&&) noexcept;

    /// Encodes a batch: without loss where it has no QPs, else each framelet with its own QP, and `decode` gives what
    /// the viewer will see. Shapes always lose a little (`shape_quantisation.h`). `memory`: that of all batches before
    /// this one, to which this one is added; null: this batch stands alone. `predicts`: framelets of a batch with QPs
    /// are predicted from the picture in the memory.
    EncodedBatch encode(Batch const& batch, BatchMemory* memory = nullptr, bool predicts = true);
    /// Decodes a batch. `memory`: as it was for the encoder; null: a batch that is predicted is refused. Throws
    /// ProtocolError where payload and shapes are not exactly what the tiles ask for.
    Batch decode(EncodedBatch const& encoded, BatchMemory* memory = nullptr);
    /// Decodes likewise, into the memory of a batch that was decoded before, which grows to what the largest one needs.
    /// After an error the content of `batch` means nothing.
    void decode(EncodedBatch const& encoded, BatchMemory* memory, Batch& batch);

private:
    struct Scratch;

    Bytes encode_shapes(Batch const& batch, BatchModels& models);
    void decode_shapes(EncodedBatch const& encoded, ImagePlane const& plane, BatchModels& models,
                       std::vector<FrameletShape>& shapes);

    std::unique_ptr<Scratch> scratch_;
};

} // namespace framelet
