// What codecs of framelets are compared on. In: a scene. Out: the batches that the scheduler sends of it while
// everything moves.
#pragma once

#include <vector>

#include "common/framelet.h"
#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

struct CorpusOptions {
    Viewport viewport{1280, 720};
    int moments = 3; ///< spread over the animation
    double lead_seconds = 0.4; ///< before each moment, so that the scheduler knows what moves
    double seconds = 0.1; ///< of each moment
    double frames_per_second = 10; ///< samples a second, in whole pictures at one sample a pixel
};

/// The batches of one moment, in the order in which they were sent, and those before it that the viewer has then.
struct CorpusMoment {
    std::vector<Batch> lead;
    std::vector<Batch> batches;
};

/// Poses the scene; the same batches each time.
std::vector<CorpusMoment> make_corpus(BenchScene& scene, CorpusOptions const& options);

} // namespace framelet::bench
