// What every stage costs, nanoseconds on one thread: measured by `framelet-bench calibrate`, carried by the repository
// (tests/evaluation/costs.json), read by everything that runs on the virtual clock.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace framelet::bench {

struct CostTable {
    double coherent_segment = 0; ///< one ray of a framelet, its share of shading included
    double incoherent_segment = 0; ///< one ray of samples at random places
    double display_sample = 0; ///< tone curve and sRGB
    double plan_region = 0; ///< the response's planning of a cycle, a place of the picture
    double learn_sample = 0; ///< what the response learns from one sample
    double encode_sample = 0; ///< batch codec
    double decode_sample = 0;
    double encode_lossy_sample = 0; ///< the same with loss, predicted
    double decode_lossy_sample = 0;
    double cache_sample = 0; ///< insertion into the framelet cache
    double reconstruct_pixel = 0; ///< from samples not finer than a pixel
    double reconstruct_fine_sample = 0; ///< one sample finer than a pixel
    double reproject_pixel = 0; ///< from samples of another camera or time
    double shape_sample = 0; ///< fitting and coding where a framelet's samples lie
    double place_pixel = 0; ///< writing a received pixel to where it belongs
    double afr_sample = 0; ///< adaptive frameless rendering's choice and statistics of one sample
    double estimate_sample = 0; ///< sample-rate error by streaming Haar transform
    double respond_element = 0; ///< response decision of one element that has an error
    double tiling_element = 0; ///< tiling from density, one element of the field
    double blend_pixel = 0; ///< age-weighted reconstruction: age, its smoothing, normalisation of a pixel
    double blend_contribution = 0; ///< of a framelet to a pixel, by four samples
    double h264_encode_pixel = 0;
    double h264_decode_pixel = 0;
};

/// Throws InputError where the file is not a complete table of positive numbers.
CostTable read_cost_table(std::filesystem::path const& file);
nlohmann::json to_json(CostTable const& costs);

} // namespace framelet::bench
