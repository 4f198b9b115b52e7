#include "server/sampling/plan/refinement_selection.h"

#include <algorithm>
#include <functional>

#include "server/render/rays_per_sample.h"
#include "server/sampling/plan/patch_selection.h"

namespace framelet {
namespace {

/// Mean squared error of the finest samples, as modelled, above which they are not enough of a still picture.
constexpr float enough = 5e-5f;

/// True where the viewer holds the finest samples of the region, of a picture that stands since `still_since`, as far
/// as is learnt.
bool is_finest(Region const& region, double still_since) {
    return region.level == sampling_levels - 1 && region.rendered >= still_since;
}

} // namespace

bool is_finished(Region const& region, double still_since) {
    return is_finest(region, still_since) && (region.supersampled || region.left <= enough);
}

void select_refinement(RegionField const& field, double samples, UnresolvedRegions& scratch,
                       std::vector<Patch>& patches) {
    scratch.clear();
    for (std::uint32_t const index : field.visible()) {
        Region const& region = field[index];
        if (region.level < 0 || region.level + 1 >= sampling_levels || region.taken.level >= 0) {
            continue;
        }
        int const finer = region.level + 1;
        float const gain = unresolved_error(region.model, region.level) - unresolved_error(region.model, finer);
        if (gain > 0) {
            scratch.push_back({gain / samples_per_pixel(finer), index});
        }
    }
    std::ranges::sort(scratch, std::ranges::greater());
    std::size_t const before = patches.size();
    double planned = 0;
    for (auto const& [gain, index] : scratch) {
        Patch const patch = field.patch_of(index, std::max(field.depth_of(field[index].level + 1), field.depth()));
        if (!append_new(patch, before, patches)) {
            continue;
        }
        planned += tile_count(patch) * framelet_samples;
        if (planned >= samples) {
            return;
        }
    }
}

void select_completion(RegionField const& field, double still_since, bool scene_moves, double samples,
                       std::vector<Patch>& patches) {
    double tiles = 0;
    for (std::uint32_t const index : field.visible()) {
        Region const& region = field[index];
        bool const fine = region.level == sampling_levels - 1 && region.settled;
        bool const taken = region.taken.level == sampling_levels - 1 && region.taken.when >= still_since;
        if (is_finest(region, still_since) || taken ||
            (scene_moves && fine)) { // while things move, probes and periodic refreshes are enough
            continue;
        }
        Patch const patch = field.patch_of(index, field.plane().max_depth());
        patches.push_back(patch);
        tiles += tile_count(patch);
        if (tiles * framelet_samples >= samples) {
            return;
        }
    }
}

void select_supersampling(RegionField const& field, double still_since, double samples, UnresolvedRegions& scratch,
                          std::vector<Patch>& patches) {
    scratch.clear();
    for (std::uint32_t const index : field.visible()) {
        if (is_finest(field[index], still_since) && !is_finished(field[index], still_since) &&
            field[index].taken.level < 0) {
            scratch.push_back({field[index].left, index});
        }
    }
    std::ranges::sort(scratch, std::ranges::greater());
    double rays = 0;
    for (auto const& [error, index] : scratch) {
        Patch const patch = field.patch_of(index, field.plane().max_depth());
        patches.push_back(patch);
        rays += tile_count(patch) * framelet_samples * four_rays;
        if (rays >= samples) {
            return;
        }
    }
}

} // namespace framelet
