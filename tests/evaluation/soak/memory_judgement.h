// Judges whether memory grows over a soak. In: what was held in the calms of each quarter of the time. Out: whether it
// grows, and in words what was compared, or why nothing was.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tests/evaluation/soak/process_watch.h"

namespace framelet::bench {

/// Least pairs of calms after the same storm that are compared.
inline constexpr std::size_t least_pairs = 5;

/// Share of the memory by which it may grow from one quarter to the next even where that is no chance: an allocator
/// keeps more of its pages from storm to storm, in pieces that it can use again, and comes to an end of it after hours.
/// What leaks more slowly than so much a quarter is found by a soak that takes longer.
inline constexpr double memory_noise = 0.02;

struct MemoryJudgement {
    std::optional<Growth> growth; ///< nothing where there were too few calms to compare
    bool grows = false;
    std::string text; ///< one line without an end
};

/// Compares the last quarter with the one before, pair by pair in their order: the same storm came before both of a
/// pair. `whose`: "the server's".
MemoryJudgement judge_memory(std::array<std::vector<double>, 4> const& bytes, std::string const& whose);

} // namespace framelet::bench
