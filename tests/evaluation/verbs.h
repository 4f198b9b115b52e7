// The verbs of framelet-bench but those of real programs: each is one question. A verb prints what it found, draws
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
    nlohmann::json (*answer)(VerbOptions& options); ///< of settled options
    std::vector<std::string> scenes; ///< where none are told; empty: all bundled ones
    Scale usual{}, quick{.viewport = {256, 144}, .seconds = 1};
    void (*add_options)(CLI::App& verb, VerbOptions& options) = nullptr; ///< what is its own; null: nothing
};

std::span<Verb const> verbs();

} // namespace framelet::bench
