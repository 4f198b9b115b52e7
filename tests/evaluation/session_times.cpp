#include "tests/evaluation/session_times.h"

#include <initializer_list>

namespace framelet::bench {

CostTable calibrated(CostTable costs, SessionTimes const& times) {
    auto const scale = [&costs](SessionTimes::Stage const& stage, std::initializer_list<double CostTable::*> entries) {
        for (double CostTable::*const entry : entries) {
            costs.*entry *= stage.factor();
        }
    };
    scale(times.plan, {&CostTable::plan_region});
    scale(times.render, {&CostTable::coherent_segment, &CostTable::incoherent_segment, &CostTable::display_sample});
    scale(times.learn, {&CostTable::learn_sample, &CostTable::shape_sample});
    scale(times.encode, {&CostTable::encode_sample, &CostTable::encode_lossy_sample});
    scale(times.decode, {&CostTable::decode_sample, &CostTable::decode_lossy_sample});
    scale(times.insert, {&CostTable::cache_sample});
    scale(times.paint,
          {&CostTable::reconstruct_pixel, &CostTable::reconstruct_fine_sample, &CostTable::reproject_pixel});
    return costs;
}

} // namespace framelet::bench
