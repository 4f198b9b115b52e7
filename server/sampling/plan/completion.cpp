#include "server/sampling/plan/completion.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "common/color.h"
#include "server/render/rays_per_sample.h"

namespace framelet {
namespace {

/// Mean squared error of the finest samples above which they are not enough of a still picture.
constexpr float enough = 5e-5f;

/// True where the viewer holds the finest samples of the region.
bool is_finest(Region const& region, double still_since) {
    return region.level == finest_level && region.rendered >= still_since;
}

} // namespace

bool is_enough(float left) {
    return left <= enough;
}

bool is_finished(Region const& region, double still_since) {
    return is_finest(region, still_since) && (region.supersampled || is_enough(region.left));
}

float error_left(std::span<DisplayFramelet const> framelets) {
    constexpr std::size_t block = 4; // 2x2 samples, side by side in Morton order
    float sum = 0;
    for (DisplayFramelet const& framelet : framelets) {
        for (std::size_t i = 0; i < framelet_samples; i += block) {
            float all = 0, squares = 0;
            for (std::size_t k = i; k < i + block; ++k) {
                float const luma = display_luma(framelet.red[k], framelet.green[k], framelet.blue[k]);
                all += luma;
                squares += luma * luma;
            }
            sum += std::max(squares - all * all / block, 0.0f);
        }
    }
    float const resolved = sum / static_cast<float>(framelets.size() * framelet_samples);
    return resolved / samples_per_pixel(finest_level);
}

void select_finest(RegionGrid const& regions, double still_since, double samples, std::vector<Patch>& patches) {
    double planned = 0;
    for (std::uint32_t const index : regions.visible()) {
        Region const& region = regions[index];
        bool const taken = region.taken.level == finest_level && region.taken.when >= still_since;
        if (planned < samples && !is_finest(region, still_since) && !taken) {
            patches.push_back(regions.patch_of(index, regions.plane().max_depth()));
            planned += tile_count(patches.back()) * framelet_samples;
        }
    }
}

void select_supersampling(RegionGrid const& regions, double still_since, double samples, std::vector<Patch>& patches) {
    std::vector<std::pair<float, std::uint32_t>> unfinished;
    for (std::uint32_t const index : regions.visible()) {
        Region const& region = regions[index];
        if (is_finest(region, still_since) && !is_finished(region, still_since) && region.taken.level < 0) {
            unfinished.push_back({region.left, index});
        }
    }
    std::ranges::sort(unfinished, std::ranges::greater());
    double planned = 0;
    for (auto const& [left, index] : unfinished) {
        if (planned < samples) {
            patches.push_back(regions.patch_of(index, regions.plane().max_depth()));
            planned += tile_count(patches.back()) * framelet_samples * four_rays;
        }
    }
}

} // namespace framelet
