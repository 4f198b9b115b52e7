// The verbs of framelet-bench but those of real programs: each answers one question. A verb prints what it found, draws
// charts where it is told to, and returns the figures.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/verb_options.h"

namespace framelet::bench {

struct Verb {
    char const* name;
    char const* question;
    nlohmann::json (*answer)(VerbOptions& options); ///< takes options after `settle`
    std::vector<std::string> scenes; ///< default scenes; empty: all bundled ones
    Scale usual{}, quick{.viewport = {256, 144}, .seconds = 1};
    /// Adds the options of this verb alone; null: it has none.
    void (*add_options)(CLI::App& verb, VerbOptions& options) = nullptr;
};

std::span<Verb const> verbs();

} // namespace framelet::bench
