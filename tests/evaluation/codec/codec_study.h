// framelet-bench codec: bytes of a sample against the error of what is decoded, and what that costs. In: scenes. Out:
// a table, figures, charts.
#pragma once

#include <filesystem>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/codec/corpus.h"

namespace framelet::bench {

struct CodecStudy {
    std::vector<std::filesystem::path> scenes;
    CorpusOptions corpus;
    int rounds = 25; ///< each moment's batches are coded so often; the fastest round counts: machines are shared
    std::filesystem::path charts; ///< folder; empty: none are drawn
};

/// Exact framelets (`planes`), and with loss at several steps: predicted from what the viewer holds (`predicted`) and
/// alone (`haar`). On one thread.
nlohmann::json compare_codecs(CodecStudy const& study);

} // namespace framelet::bench
