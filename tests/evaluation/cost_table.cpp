#include "tests/evaluation/cost_table.h"

#include <array>
#include <fstream>
#include <utility>

#include <nlohmann/json.hpp>

#include "common/error.h"

namespace framelet::bench {
namespace {

constexpr std::array<std::pair<char const*, double CostTable::*>, 23> fields{{
    {"coherent_segment", &CostTable::coherent_segment},
    {"incoherent_segment", &CostTable::incoherent_segment},
    {"display_sample", &CostTable::display_sample},
    {"plan_region", &CostTable::plan_region},
    {"learn_sample", &CostTable::learn_sample},
    {"encode_sample", &CostTable::encode_sample},
    {"decode_sample", &CostTable::decode_sample},
    {"encode_lossy_sample", &CostTable::encode_lossy_sample},
    {"decode_lossy_sample", &CostTable::decode_lossy_sample},
    {"cache_sample", &CostTable::cache_sample},
    {"reconstruct_pixel", &CostTable::reconstruct_pixel},
    {"reconstruct_fine_sample", &CostTable::reconstruct_fine_sample},
    {"reproject_pixel", &CostTable::reproject_pixel},
    {"shape_sample", &CostTable::shape_sample},
    {"place_pixel", &CostTable::place_pixel},
    {"afr_sample", &CostTable::afr_sample},
    {"estimate_sample", &CostTable::estimate_sample},
    {"respond_element", &CostTable::respond_element},
    {"tiling_element", &CostTable::tiling_element},
    {"blend_pixel", &CostTable::blend_pixel},
    {"blend_contribution", &CostTable::blend_contribution},
    {"h264_encode_pixel", &CostTable::h264_encode_pixel},
    {"h264_decode_pixel", &CostTable::h264_decode_pixel},
}};

} // namespace

CostTable read_cost_table(std::filesystem::path const& file) {
    std::ifstream stream(file);
    auto const json = nlohmann::json::parse(stream, nullptr, false);
    CostTable costs;
    for (auto const& [name, field] : fields) {
        if (!json.is_object() || !json.contains(name) || !json[name].is_number() || !(json[name] > 0)) {
            throw InputError("'" + file.string() + "' is not a table of costs: '" + name +
                             "' is missing or no positive number (framelet-bench calibrate writes one)");
        }
        costs.*field = json[name];
    }
    return costs;
}

nlohmann::json to_json(CostTable const& costs) {
    nlohmann::json json;
    for (auto const& [name, field] : fields) {
        json[name] = costs.*field;
    }
    return json;
}

} // namespace framelet::bench
