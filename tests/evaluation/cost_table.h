// Costs of every stage, nanoseconds on one thread: measured by `framelet-bench calibrate`, carried by the repository
// (tests/evaluation/costs.json), read by everything that runs on the virtual clock.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace framelet::bench {

struct CostTable {
    double coherent_segment = 0; ///< one ray of a framelet, its share of shading included
    double incoherent_segment = 0; ///< one ray of samples at random positions
    double display_sample = 0; ///< tone curve and sRGB
    double plan_region = 0; ///< planning of a cycle by the response, one region
    double learn_sample = 0; ///< the response's learning from one sample
    double encode_sample = 0; ///< coding one sample with the batch codec, without loss
    double decode_sample = 0;
    double encode_lossy_sample = 0; ///< coding one sample with loss, predicted from what the viewer holds
    double decode_lossy_sample = 0;
    double cache_sample = 0; ///< insertion of one sample into the framelet cache
    double reconstruct_pixel = 0; ///< one pixel from samples not finer than a pixel
    double reconstruct_fine_sample = 0; ///< one sample finer than a pixel
    double reproject_pixel = 0; ///< one pixel from samples of another camera or time
    double shape_sample = 0; ///< fitting and coding of one sample's shape: where it lies, what carries it
    double place_pixel = 0; ///< writing a received pixel to where it belongs
    double afr_sample = 0; ///< adaptive frameless rendering's choice and statistics of one sample
    double estimate_sample = 0; ///< sample-rate error of one sample by streaming Haar transform
    double respond_element = 0; ///< response decision for one element that has an error
    double tiling_element = 0; ///< tiling from density for one element of the field
    double blend_pixel = 0; ///< age-weighted reconstruction of one pixel: its age, smoothing, normalisation
    double blend_contribution = 0; ///< age-weighted contribution of a framelet to a pixel, by four samples
    double h264_encode_pixel = 0;
    double h264_decode_pixel = 0;
};

/// Reads a table from a JSON file. Throws InputError where that is not a complete table of positive numbers.
CostTable read_cost_table(std::filesystem::path const& file);
nlohmann::json to_json(CostTable const& costs);

} // namespace framelet::bench
