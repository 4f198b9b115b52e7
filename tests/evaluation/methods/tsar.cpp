#include "tests/evaluation/methods/tsar.h"

#include "tests/evaluation/methods/methods.h"

namespace framelet::bench {

Tsar::Tsar(MethodSetup const& setup, TsarParameters const& parameters)
    : costs_(setup.costs), server_(setup, parameters), viewer_(ImagePlane(setup.viewport)) {}

ViewerStep Tsar::consume(std::vector<std::byte> const& message) {
    TsarMessage const decoded = decode_tsar_message(message);
    Batch const batch = codec_.decode(decoded.batch);
    BlendWork const work = viewer_.show(batch.framelets, decoded.time, batch.scene_time);
    double const samples = static_cast<double>(batch.framelets.size() * framelet_samples);
    ViewerStep step;
    step.seconds.decode = 1e-9 * samples * costs_.decode_sample;
    step.seconds.reconstruct =
        1e-9 * (work.pixels * costs_.blend_pixel + work.contributions * costs_.blend_contribution);
    return step;
}

std::unique_ptr<Method> make_tsar(MethodSetup const& setup) {
    return std::make_unique<Tsar>(setup);
}

} // namespace framelet::bench
