// The server's half of `tsar` ([Stephens 2011] chapters 3 to 6): density -> tiling -> batch -> error -> density.
#pragma once

#include <unordered_map>

#include "protocol/codec/batch_codec.h"
#include "tests/evaluation/method.h"
#include "tests/evaluation/methods/response/density_response.h"
#include "tests/evaluation/methods/response/haar_error.h"
#include "tests/evaluation/methods/tsar_schedule.h"

namespace framelet::bench {

/// Parameters that [Stephens 2011] leaves to experiment ("determined empirically", section 7.1.2.1).
struct TsarParameters {
    RateTemplates templates = haar_templates;
    double gain = 1; ///< samples per pixel, and slowest rates of refresh, that an error of 1 asks for: eq. 6.11 has 1
    /// Samples that a tile may have by its density before it is split: the geometric mean of a framelet's samples and
    /// those of its four children, so that the tiling has neither more nor fewer samples than the density.
    double most_samples = 2 * framelet_samples;
};

class TsarServer {
public:
    TsarServer(MethodSetup const& setup, TsarParameters const& parameters);

    /// Renders and sends one batch, then responds to it.
    ServerStep produce(StepInput const& input);

private:
    /// Record of a tile's last framelet.
    struct TileRecord {
        HaarHistory history;
        double time = 0;
    };

    void build_tiling();
    void estimate(Batch const& batch);
    void forget_old_records();

    MethodSetup const setup_;
    TsarParameters const parameters_;
    ImagePlane const plane_;
    std::size_t const batch_framelets_;
    ResponseParameters response_;
    ResponseScratch scratch_;

    DensityField density_;
    std::vector<double> refreshed_; ///< seconds at which each element was refreshed last
    Tiling tiling_;
    std::unordered_map<std::uint32_t, TileRecord> records_; ///< by tile code
    std::vector<std::uint32_t> elements_; ///< elements that the batch touched
    std::vector<RateError> errors_; ///< errors of those elements

    double clock_ = 0; ///< the server's own clock, seconds
    double last_input_ = 0;
    BatchCodec codec_;
    Batch batch_;
};

/// Content of a message: when the batch was rendered by the server's clock (seconds), which goes on while the scene's
/// stands still, and the batch.
struct TsarMessage {
    double time;
    EncodedBatch batch;
};
TsarMessage decode_tsar_message(std::vector<std::byte> const& message);

} // namespace framelet::bench
