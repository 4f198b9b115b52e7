// Records what a cycle did for one viewer, in figures. In: the scheduler when it has planned a batch, and what became
// of that. Out: a line of JSON.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "server/sampling/plan/adaptive_refresh.h"

namespace framelet {

/// One batch of a cycle; a cycle has several where batches are small.
struct CycleRecord {
    std::uint64_t session = 0;
    std::uint64_t cycle = 0; ///< counts from 1
    double seconds = 0; ///< since the recording began
    SceneTime scene_time = 0;
    double price = 0;
    double budget = 0; ///< samples that the cycle has time for
    std::uint64_t samples_planned = 0; ///< of the whole cycle, probes not included; one of four rays counts as four
    std::uint64_t samples_rendered = 0; ///< of this batch
    std::uint64_t framelets_sent = 0;
    std::uint64_t framelets_unchanged = 0; ///< rendered, and the viewer had them
    std::uint64_t probes = 0;
    /// Number of regions by the level that the viewer holds there; first: those without any.
    std::array<std::uint64_t, sampling_levels + 1> regions_by_level{};
    double mean_shown_error = 0; ///< mean squared error over the viewport's pixels
    struct {
        double plan = 0, render = 0;
        double learn = 0; ///< while the next batch was being rendered
        double wait = 0; ///< from the end of rendering until the batch before was encoded and sent
    } stage_seconds;
};

/// Fills in what the scheduler knows of its cycle and field, what was taken for the batch included.
void describe(AdaptiveRefresh const& refresh, CycleRecord& record);

/// The record as a line of JSON, without the end of line.
std::string to_json_line(CycleRecord const& record);

} // namespace framelet
