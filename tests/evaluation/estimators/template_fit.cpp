#include "tests/evaluation/estimators/template_fit.h"

#include <cmath>

namespace framelet::bench {
namespace {

struct Best {
    EnergyTemplate line;
    double score = -1;

    void offer(EnergyTemplate const& candidate, double candidate_score) {
        bool const flatter = std::abs(candidate.slope) < std::abs(line.slope);
        if (candidate_score > score || (candidate_score == score && flatter)) {
            *this = {candidate, candidate_score};
        }
    }
};

} // namespace

RateTemplates fit_templates(ErrorEstimator const& estimator, std::span<Place const> places) {
    Best space, time;
    // The axes do not know of each other: one run tries a candidate for each.
    auto const search = [&](EnergyTemplate space_middle, EnergyTemplate time_middle, int offsets, float offset_step,
                            int slopes, float slope_step) {
        for (int i = -offsets; i <= offsets; ++i) {
            for (int j = -slopes; j <= slopes; ++j) {
                float const offset = static_cast<float>(i) * offset_step, slope = static_cast<float>(j) * slope_step;
                RateTemplates const candidate{{space_middle.offset + offset, space_middle.slope + slope},
                                              {time_middle.offset + offset, time_middle.slope + slope}};
                Verdicts const verdicts = judge(estimator, candidate, places);
                space.offer(candidate.space, sign_agreement(verdicts.space).balanced);
                time.offer(candidate.time, sign_agreement(verdicts.time).balanced);
            }
        }
    };
    search({-12, 0.5f}, {-12, 0.5f}, 5, 2, 3, 1);
    for (float step = 1; step >= 0.25f; step /= 2) {
        search(space.line, time.line, 2, step, 2, step / 2);
    }
    return {space.line, time.line};
}

} // namespace framelet::bench
