#include "server/sampling/plan/moment/moment_plan.h"

#include <algorithm>
#include <cmath>

#include <tbb/parallel_for.h>

#include "common/error.h"
#include "common/framelet/sample_worth.h"

namespace framelet {
namespace {

/// Detail of what nothing is known of.
constexpr float unknown_detail = 0.0025f;
/// Squared luma by which what was rendered before the scene jumped is taken to look otherwise, where no probe has told.
constexpr float outdated_error = 2e-4f;
/// Squared luma by which what the viewer has moved is taken to look otherwise once all stands. What has not is as
/// likely right, and finer than what would take its place.
constexpr float moved_doubt = 1e-3f;
/// The largest error of samples: however coarse they are, their mean is about right.
constexpr float most_error = 0.1f;
/// Pixels of spacing that interpolated samples seem to lie farther apart, beside those that come to lie on their own
/// pixels before a camera that stands.
constexpr float interpolated_wear = 1;
/// The bounds of the price of a sample, squared error summed over pixels; others are of no use.
constexpr float least_price = 5e-6f, most_price = 1e2f;

constexpr std::size_t supersampled = MomentPlan::supersampled;
/// Samples half a pixel apart. While anything moves, means of four rays show as much for a quarter of the bytes.
constexpr int halved_level = pixel_level + 1;
using ChoiceFigures = MomentPlan::ChoiceFigures;

/// Error of samples `s` pixels apart, as a multiple of the detail: what they miss, and what aliases.
constexpr float missed_share(float s) {
    constexpr float alias = 4.0f / 9.0f;
    return s <= 1   ? s * s * s // the mean of 1 / s^2 samples, of what lies between them
           : s <= 2 ? 1 + (s - 1) * 2 * alias
                    : error_growth * s - 1;
}

/// Factors on the spacing that make samples as good as means of four rays: by the mean's definition where they stay on
/// their own pixels, by measurement once moved, where they blur and wear out before they have repaid four rays.
constexpr float standing_supersampled = 0.5f, moved_supersampled = 0.95f;

/// Share of the detail that each choice misses. `finest`: spacing, pixels, below which nothing shows better; `means`:
/// spacing, pixels, that means of four rays at a sample a pixel seem to have.
constexpr ChoiceFigures missed_shares(float finest, float means) {
    ChoiceFigures shares{};
    for (int level = 0; level < sampling_levels; ++level) {
        shares[static_cast<std::size_t>(level)] = missed_share(std::max(spacing_of(level), finest));
    }
    shares[supersampled] = missed_share(means);
    return shares;
}

/// Shares of samples that the viewer moves, and of samples that stay on their own pixels, which show the mean of all.
constexpr ChoiceFigures moved_shares = missed_shares(finest_shown_spacing, moved_supersampled),
                        standing_shares = missed_shares(0, standing_supersampled);

/// Spacing, pixels, by which the viewer rates fresh samples of each choice.
constexpr ChoiceFigures shown_spacings = [] {
    ChoiceFigures spacings{};
    spacings.fill(finest_shown_spacing); // means of rays are a pixel apart
    for (int level = 0; level < pixel_level; ++level) {
        spacings[static_cast<std::size_t>(level)] = spacing_of(level);
    }
    return spacings;
}();

/// What errors count as the viewer wishes: those of what has passed, those of what is missing between samples. `bias`:
/// -1 (spatial fidelity) .. 1 (temporal); 4 to its power, and the inverse.
struct BiasWeights {
    explicit BiasWeights(float bias) : time(bias == 0 ? 1 : std::exp2(2 * bias)), space(1 / time) {}

    float time, space;
};

/// True where means of rays show; of samples finer than pixels too the viewer moves the means.
bool shows_means(Cell const& cell, bool stands) {
    return cell.is_supersampled || (!stands && cell.spacing < 1);
}

/// True where a cell is worth the finest samples: as far as is known it will show the same for a second, in which they
/// wear by less than what they are finer.
bool stays(Mirror const& mirror, Cell const& cell) {
    constexpr float most_decorrelation = 0.25f; // pixels a second
    if (!mirror.camera_stands() || !cell.is_shown() || !mirror.gives_way(cell) || cell.is_outdated || cell.is_wrong ||
        cell.stale > 0) {
        return false;
    }
    return !cell.moves && cell.decorrelation < most_decorrelation;
}

/// True where what shows was rendered for another moment and has been moved to this one.
bool has_moved(Mirror const& mirror, Cell const& cell) {
    return mirror.is_moved(cell) || (cell.moves && mirror.time_of(cell) != mirror.view().scene_time);
}

/// The detail for which a cell counts: the geometric mean of its own and of the picture's. What is known of a cell's
/// detail is a few differences of samples, which tend to be nearer to the mean than they seem; and a difference is seen
/// the less the more differs beside it.
float counted_detail(float detail, float mean) {
    return std::sqrt(detail * mean);
}

/// Mean squared error of samples `spacing` pixels apart (worn), of a surface of such `detail` (see `Piece`): what is
/// missing and what aliases.
float spacing_error(float detail, float spacing) {
    return std::min(detail * missed_share(spacing), most_error);
}

/// Level of what the viewer has of this moment of a region, be it on its way or rendered, whatever the mirror makes of
/// it; -1: nothing.
int level_had(Region const& region, double moment_begun) {
    bool const is_rendered = region.rendered >= moment_begun;
    return std::max(region.taken.level, is_rendered ? shown_level(region.level, region.rays_per_sample) : -1);
}

/// Calls `visit` with each cell of a rectangle and how many pixels it has.
template <class Visit>
void for_each_cell(Mirror const& mirror, PixelRect const& rect, Visit visit) {
    int const last_column = std::min(rect.right / cell_side, mirror.columns());
    int const last_row = std::min(rect.bottom / cell_side, mirror.rows());
    for (int row = rect.top / cell_side; row < last_row; ++row) {
        for (int column = rect.left / cell_side; column < last_column; ++column) {
            visit(mirror.cell(column, row), static_cast<float>(mirror.pixels_of(column, row)));
        }
    }
}

} // namespace

void select_most_urgent(double budget, double most_samples, std::vector<RatedPatch>& rated) {
    std::sort(rated.begin(), rated.end(), [](RatedPatch const& a, RatedPatch const& b) {
        return a.urgency != b.urgency ? a.urgency > b.urgency : a.patch.node < b.patch.node;
    });
    double spent = 0;
    double samples = 0;
    std::size_t count = 0;
    while (count < rated.size() && spent < budget && samples < most_samples) {
        spent += rated[count].cost;
        samples += rated[count].samples;
        ++count;
    }
    rated.resize(count);
}

void MomentPlan::find(Mirror const& mirror, RegionGrid const& regions, MomentBudget const& budget,
                      std::vector<RatedPatch>& rated) {
    FRAMELET_CHECK(mirror.viewport() == regions.plane().viewport());
    rated.clear();
    find_gains(mirror, regions, budget);
    sum_nodes(regions, budget);
    float low = least_price, high = most_price, price = least_price;
    if (solve(regions, budget, least_price) > budget.samples) {
        for (int step = 0; step < 18; ++step) {
            float const middle = std::sqrt(low * high);
            (solve(regions, budget, middle) > budget.samples ? low : high) = middle;
        }
        price = high;
        if (!(solve(regions, budget, high) > 0)) { // rather a little more than none at all
            price = low;
            solve(regions, budget, low);
        }
    }
    if (budget.limits.coarse_first && stale_ > 0.5f * wrong_) {
        choose_horizon(regions, budget, price);
    }
    collect(regions, 0, 0, rated);
}

/// Chooses among prices from `least` up the one whose patches gain most a second, where each plan takes `overhead`
/// samples besides: what gains much for few samples shows before what those lack is refined.
void MomentPlan::choose_horizon(RegionGrid const& regions, MomentBudget const& budget, float least) {
    constexpr int most_steps = 12;
    float best_rate = -1;
    float best = least;
    for (int step = 0; step <= most_steps; ++step) {
        float const price = std::ldexp(least, step);
        auto const spent = static_cast<float>(solve(regions, budget, price));
        float const rate = gain_ / (spent + static_cast<float>(budget.overhead));
        if (rate > best_rate) {
            best_rate = rate;
            best = price;
        }
    }
    solve(regions, budget, best);
}

/// Rates the regions in which anything has changed since the last call; all of them once the mirror has looked anew, or
/// the picture's detail is another.
void MomentPlan::find_gains(Mirror const& mirror, RegionGrid const& regions, MomentBudget const& budget) {
    constexpr float other_detail = 1.25f; // less does not change what is best
    std::span<std::uint32_t const> const visible = regions.visible();
    bool rates_all = leaves_.size() != regions.size() || !knows(mirror, budget);
    leaves_.resize(regions.size());
    tbb::parallel_for(std::size_t{0}, visible.size(), [&](std::size_t i) {
        std::uint32_t const index = visible[i];
        Leaf& leaf = leaves_[index];
        int const had = level_had(regions[index], budget.moment_begun);
        leaf.is_rated = !rates_all && leaf.had == had && !mirror.has_changed(regions.rect_of(index), changes_);
        leaf.had = had;
        if (!leaf.is_rated) {
            find_detail(mirror, regions, index);
        }
    });
    float detail = 0, shown = 0;
    for (std::uint32_t const index : visible) {
        detail += leaves_[index].detail;
        shown += leaves_[index].shown;
    }
    float const mean = shown > 0 ? detail / shown : unknown_detail;
    if (rates_all || mean > other_detail * mean_detail_ || mean_detail_ > other_detail * mean) {
        mean_detail_ = mean;
        rates_all = true;
    }
    tbb::parallel_for(std::size_t{0}, visible.size(), [&](std::size_t i) {
        if (rates_all || !leaves_[visible[i]].is_rated) {
            rate(mirror, regions, visible[i], budget);
        }
        find_costs(regions, visible[i], budget);
    });
    changes_ = mirror.changes();
    looked_ = mirror.looked();
    bias_ = budget.bias;
    rests_ = budget.rests;
    stale_ = wrong_ = 0;
    for (std::uint32_t const index : visible) {
        stale_ += leaves_[index].stale;
        wrong_ += leaves_[index].wrong;
    }
}

/// True where the regions were rated for the same picture and wishes.
bool MomentPlan::knows(Mirror const& mirror, MomentBudget const& budget) const {
    return looked_ == mirror.looked() && bias_ == budget.bias && rests_ == budget.rests;
}

/// Sums up the detail that shows in one region.
void MomentPlan::find_detail(Mirror const& mirror, RegionGrid const& regions, std::uint32_t index) {
    float detail = 0, shown = 0;
    for_each_cell(mirror, regions.rect_of(index), [&](Cell const& cell, float) {
        detail += cell.is_shown() ? cell.detail : 0;
        shown += cell.is_shown() ? 1.0f : 0.0f;
    });
    leaves_[index].detail = detail;
    leaves_[index].shown = shown;
}

/// Finds what each choice gains in one region.
void MomentPlan::rate(Mirror const& mirror, RegionGrid const& regions, std::uint32_t index,
                      MomentBudget const& budget) {
    Leaf& leaf = leaves_[index];
    int const had = leaf.had;
    BiasWeights const weights(budget.bias);
    float const hole = std::max(weights.time, weights.space) * hole_error; // it is missing in space as in time
    float const hidden_detail = detail_of(leaf);
    FloatLanes gains{};
    float stale_sum = 0, wrong_sum = 0;
    for_each_cell(mirror, regions.rect_of(index), [&](Cell const& cell, float pixels) {
        // New samples show although they are worse, or only where they are better, whatever the old ones show.
        bool const gives_way = cell.is_shown() && (budget.rests || mirror.gives_way(cell));
        float const least = gives_way ? -weights.space * most_error : 0.0f;
        float const too_coarse = gives_way || !cell.is_shown() ? INFINITY : worn_of_step(cell.worn).second;
        float covered = cell.is_wrong ? 0 : cell.covered_share() * pixels;
        float const own_detail = cell.is_shown() ? cell.detail : hidden_detail;
        float const detail = budget.rests ? own_detail : counted_detail(own_detail, mean_detail_);
        float worn = cell.is_shown() ? cell.worn : INFINITY;
        worn += cell.is_shown() && mirror.camera_stands() && mirror.is_moved(cell) ? interpolated_wear : 0;
        float stale = cell.is_outdated ? std::max(cell.stale, outdated_error) : cell.stale;
        if (budget.rests && cell.is_shown() && has_moved(mirror, cell)) {
            stale = std::max(stale, moved_doubt);
        }
        bool const stands = budget.rests || stays(mirror, cell);
        if (stands && worn <= finest_shown_spacing) {
            worn = std::min(worn, cell.spacing);
        }
        if (cell.is_shown() && shows_means(cell, stands)) {
            worn *= stands ? standing_supersampled : moved_supersampled;
        }
        if (had >= 0) {
            covered = pixels;
            if (shown_spacings[static_cast<std::size_t>(had)] < too_coarse) {
                worn = std::min(worn, spacing_of(had));
                stale = 0;
            }
        }
        float const shown = covered > 0 ? spacing_error(detail, worn) + stale : 0;
        float const bare = pixels - covered;
        stale_sum += covered * stale;
        wrong_sum += covered * shown + bare * hole_error;
        // What lies between the samples as they were rendered is missing in space, the rest has passed with time.
        float const missing = spacing_error(detail, std::min(worn, cell.spacing));
        float const now = weights.time * shown + (weights.space - weights.time) * missing;
        FloatLanes const shares = load_lanes((stands ? standing_shares : moved_shares).data());
        FloatLanes const then = weights.space * smaller(detail * shares, FloatLanes{} + most_error);
        FloatLanes const gain = larger(now - then, FloatLanes{} + least);
        gains += covered * (load_lanes(shown_spacings.data()) < too_coarse ? gain : FloatLanes{}) +
                 bare * larger(hole - then, FloatLanes{});
    });
    store_lanes(gains, leaf.gain.data());
    leaf.stale = stale_sum;
    leaf.wrong = wrong_sum;
}

/// Finds what each choice costs in one region.
void MomentPlan::find_costs(RegionGrid const& regions, std::uint32_t index, MomentBudget const& budget) {
    Leaf& leaf = leaves_[index];
    LevelCosts const bits = budget.mean_bits > 0 ? coded_bits(detail_of(leaf)) : LevelCosts{};
    for (int level = regions.least_level(); level < sampling_levels; ++level) {
        auto const l = static_cast<std::size_t>(level);
        float const factor = budget.mean_bits > 0 ? bits[l] / budget.mean_bits : 1.0f;
        leaf.cost[l] = samples_per_pixel(level) * regions.pixels_of(index) * factor;
    }
    // Rays are cheaper than samples as far as the link leaves time for them.
    leaf.cost[supersampled] = leaf.cost[pixel_level] * std::max(1.0f, four_rays / budget.rays);
}

/// Sums up gains and costs of tiles that are larger than a region.
void MomentPlan::sum_nodes(RegionGrid const& regions, MomentBudget const& budget) {
    nodes_.resize(static_cast<std::size_t>(regions.depth()));
    for (int depth = 0; depth < regions.depth(); ++depth) {
        std::vector<Node>& nodes = nodes_[static_cast<std::size_t>(depth)];
        nodes.assign(std::size_t{1} << (2 * depth), Node{});
        int const level = regions.level_of(depth);
        if (level < std::max(regions.least_level(), budget.limits.least_level) || level > budget.limits.most_level) {
            continue;
        }
        int const shift = 2 * (regions.depth() - depth);
        for (std::uint32_t const index : regions.visible()) {
            Leaf const& leaf = leaves_[index];
            Node& node = nodes[index >> shift];
            node.gain += leaf.gain[static_cast<std::size_t>(level)];
            node.cost += leaf.cost[static_cast<std::size_t>(level)];
        }
    }
}

/// Chooses what is best for the price; returns what it costs.
double MomentPlan::solve(RegionGrid const& regions, MomentBudget const& budget, float price) {
    int const first = std::max(regions.level_of(regions.depth()), budget.limits.least_level);
    bool const offers_means =
        budget.limits.most_rays >= four_rays && first <= pixel_level && pixel_level <= budget.limits.most_level;
    auto const deepest = static_cast<std::size_t>(regions.depth());
    for (std::vector<Node>& nodes : nodes_) {
        for (Node& node : nodes) {
            node.best = node.spent = 0;
        }
    }
    double all = 0;
    gain_ = 0;
    for (std::uint32_t const index : regions.visible()) {
        Leaf& leaf = leaves_[index];
        leaf.choice = no_choice;
        float best = 0;
        float spent = 0;
        auto const rate = [&](std::size_t choice) {
            float const value = leaf.gain[choice] - price * leaf.cost[choice];
            if (value > best) {
                best = value;
                leaf.choice = choice;
                spent = leaf.cost[choice];
            }
        };
        for (int level = first; level <= budget.limits.most_level; ++level) {
            if (budget.rests || !offers_means || level != halved_level) {
                rate(static_cast<std::size_t>(level));
            }
        }
        if (offers_means) {
            rate(supersampled);
        }
        if (deepest > 0) {
            nodes_[deepest - 1][index >> 2].best += best;
            nodes_[deepest - 1][index >> 2].spent += spent;
        }
        all += static_cast<double>(spent);
        gain_ += best;
    }
    for (std::size_t depth = deepest; depth-- > 0;) {
        for (std::size_t i = 0; i < nodes_[depth].size(); ++i) {
            Node& node = nodes_[depth][i];
            float const value = node.gain - price * node.cost;
            node.whole = node.cost > 0 && value > node.best;
            if (node.whole) {
                all += static_cast<double>(node.cost - node.spent);
                gain_ += value - node.best;
                node.best = value;
                node.spent = node.cost;
            }
            if (depth > 0) {
                nodes_[depth - 1][i >> 2].best += node.best;
                nodes_[depth - 1][i >> 2].spent += node.spent;
            }
        }
    }
    gain_ += price * static_cast<float>(all);
    return all;
}

void MomentPlan::collect(RegionGrid const& regions, int depth, std::uint32_t index,
                         std::vector<RatedPatch>& rated) const {
    Tile const tile{(1u << (2 * depth)) + index};
    auto const rate = [&](int tile_depth, float gain, float cost, int rays_per_sample) {
        Patch const patch{tile, tile_depth};
        rated.push_back({patch, framelet_samples * tile_count(patch) * rays_per_sample, static_cast<double>(cost),
                         static_cast<double>(gain) / static_cast<double>(cost), rays_per_sample});
    };
    if (depth == regions.depth()) {
        Leaf const& leaf = leaves_[index];
        if (leaf.choice != no_choice) {
            bool const means = leaf.choice == supersampled;
            int const level = means ? pixel_level : static_cast<int>(leaf.choice);
            rate(regions.depth_of(level), leaf.gain[leaf.choice], leaf.cost[leaf.choice],
                 means ? four_rays : single_ray);
        }
        return;
    }
    Node const& node = nodes_[static_cast<std::size_t>(depth)][index];
    if (node.whole) {
        rate(depth, node.gain, node.cost, single_ray);
    } else if (node.best > 0) {
        for (std::uint32_t child = 0; child < 4; ++child) {
            collect(regions, depth + 1, 4 * index + child, rated);
        }
    }
}

} // namespace framelet
