#include "tests/evaluation/report/run_store.h"

#include <cstdio>
#include <fstream>

#include <nlohmann/json.hpp>

#include "common/error.h"

namespace framelet::bench {

using nlohmann::json;

RunStore::RunStore(std::filesystem::path folder, std::string commit, std::size_t expected)
    : folder_(std::move(folder)), commit_(std::move(commit)), expected_(expected) {
    std::filesystem::create_directories(folder_);
}

json RunStore::get(std::string const& name, std::function<json()> const& run) {
    auto const file = folder_ / (name + ".json");
    ++done_;
    json kept = json::parse(std::ifstream(file), nullptr, false);
    if (!kept.is_object() || !kept.contains("figures") || kept.value("commit", "") != commit_) {
        std::fprintf(stderr, "%zu of %zu: %s\n", done_, expected_, name.c_str());
        kept = {{"commit", commit_}, {"figures", run()}};
        // The file has another name first, so that a run that is stopped half-way leaves no half file.
        auto const unfinished = folder_ / (name + ".unfinished");
        std::ofstream stream(unfinished);
        stream << kept.dump(1) << '\n';
        stream.close();
        if (!stream) {
            throw InputError("cannot write '" + unfinished.string() + "'");
        }
        std::filesystem::rename(unfinished, file);
    }
    return kept["figures"];
}

} // namespace framelet::bench
