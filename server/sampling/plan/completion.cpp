#include "server/sampling/plan/completion.h"

#include <algorithm>
#include <functional>
#include <tuple>

#include "common/color.h"

namespace framelet {
namespace {

/// True where the viewer holds the finest samples of the region.
bool is_finest(Region const& region, double still_since, Completion const& completion) {
    return region.level == completion.finest && region.rendered >= still_since;
}

} // namespace

bool is_finished(Region const& region, double still_since, Completion const& completion) {
    return is_finest(region, still_since, completion) &&
           (region.rays_per_sample >= completion.most_rays || region.left <= completion.enough);
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

void select_finest(RegionGrid const& regions, double still_since, Completion const& completion, double samples,
                   std::vector<Patch>& patches) {
    double planned = 0;
    for (std::uint32_t const index : regions.visible()) {
        Region const& region = regions[index];
        bool const taken = region.taken.level >= completion.finest && region.taken.when >= still_since;
        if (planned < samples && !is_finest(region, still_since, completion) && !taken) {
            patches.push_back(regions.patch_of(index, regions.depth_of(completion.finest)));
            planned += tile_count(patches.back()) * framelet_samples;
        }
    }
}

int select_supersampling(RegionGrid const& regions, double still_since, Completion const& completion, double samples,
                         std::vector<Patch>& patches) {
    struct Unfinished {
        int rays_per_sample;
        float left;
        std::uint32_t index;
    };
    std::vector<Unfinished> unfinished;
    for (std::uint32_t const index : regions.visible()) {
        Region const& region = regions[index];
        if (is_finest(region, still_since, completion) && !is_finished(region, still_since, completion) &&
            region.taken.level < 0) {
            unfinished.push_back({region.rays_per_sample, region.left, index});
        }
    }
    std::ranges::sort(unfinished, std::ranges::less(), [](Unfinished const& region) {
        return std::tuple(region.rays_per_sample, -region.left, region.index);
    });
    int const had = unfinished.empty() ? single_ray : unfinished.front().rays_per_sample;
    int const wanted = next_rays(had);
    double planned = 0;
    for (Unfinished const& region : unfinished) {
        if (planned < samples && region.rays_per_sample == had) {
            patches.push_back(regions.patch_of(region.index, regions.depth_of(completion.finest)));
            planned += tile_count(patches.back()) * framelet_samples * new_rays(wanted);
        }
    }
    return wanted;
}

} // namespace framelet
