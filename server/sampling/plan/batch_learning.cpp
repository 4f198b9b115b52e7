#include "server/sampling/plan/batch_learning.h"

#include <tbb/parallel_for.h>

namespace framelet {
void examine_batch(RegionField const& field, RefreshPlan const& plan, std::span<DisplayFramelet const> framelets,
                   std::span<Framelet const> rendered, LumaHistory const& history, BatchFindings& findings) {
    findings.firsts.clear();
    std::size_t tiles = 0;
    std::size_t regions = 0;
    for (std::size_t i = 0; i < plan.patches.size(); ++i) {
        findings.firsts.push_back({tiles, regions});
        tiles += plan.tile_counts[i];
        regions += field.range_of(plan.patches[i].node).size();
    }
    findings.entries.resize(tiles);
    findings.regions.resize(regions);
    findings.same_since.resize(plan.patches.size());
    tbb::parallel_for(std::size_t{0}, plan.patches.size(), [&](std::size_t i) {
        Patch const& patch = plan.patches[i];
        auto const [tile, region] = findings.firsts[i];
        std::size_t const count = plan.tile_counts[i];
        findings.same_since[i] =
            examine_patch(field, patch, framelets.subspan(tile, count), rendered.subspan(tile, count),
                          {plan.now, plan.moment_begun, plan.base_begun}, plan.moment, history,
                          std::span(findings.entries).subspan(tile, count),
                          std::span(findings.regions).subspan(region, field.range_of(patch.node).size()));
    });
}

void learn_batch(RegionField& field, RefreshPlan const& plan, BatchFindings const& findings,
                 std::vector<std::uint8_t>& needed) {
    needed.clear();
    for (std::size_t i = 0; i < plan.patches.size(); ++i) {
        Patch const& patch = plan.patches[i];
        auto const regions =
            std::span(findings.regions).subspan(findings.firsts[i].second, field.range_of(patch.node).size());
        bool const is_needed =
            learn_patch(field, patch, regions, findings.same_since[i], plan.still_since, plan.now, !plan.is_mirrored);
        needed.insert(needed.end(), plan.tile_counts[i], is_needed ? 1 : 0);
    }
}

void learn_supersampled(RegionField& field, RefreshPlan const& plan) {
    for (Patch const& patch : plan.patches) {
        RegionField::Range const range = field.range_of(patch.node);
        for (std::uint32_t i = range.first; i < range.last; ++i) {
            Region& region = field[i];
            region.drift = drift_since(region, plan.now);
            region.level = field.level_of(patch.depth);
            region.rendered = region.checked = plan.now;
            region.supersampled = true;
        }
    }
}

} // namespace framelet
