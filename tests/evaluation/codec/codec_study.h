// framelet-bench codec: bytes of a sample against the error of what is decoded, and what that costs. In: scenes. Out:
// a table, figures, charts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tests/evaluation/codec/corpus.h"

namespace framelet::bench {

struct CodecStudy {
    std::vector<std::filesystem::path> scenes;
    CorpusOptions corpus;
    std::vector<std::string> codecs; ///< names, of `codec_names`; empty: all
    int rounds = 25; ///< each moment's batches are coded so often; of each the fastest time counts: machines are shared
    std::filesystem::path charts; ///< folder; empty: none are drawn
};

/// Exact framelets; with loss and prediction; with loss alone; JPEG strips.
inline std::vector<std::string> const codec_names{"planes", "predicted", "haar", "jpeg"};

/// On one thread.
nlohmann::json compare_codecs(CodecStudy const& study);

} // namespace framelet::bench
