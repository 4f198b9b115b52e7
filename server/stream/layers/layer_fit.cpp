#include "server/stream/layers/layer_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "common/framelet/sample_worth.h"
#include "common/morton.h"
#include "server/stream/layers/plane_search.h"

namespace framelet {
namespace {

/// The largest number of groups of samples that are told apart in a framelet; samples of further groups are outliers.
constexpr std::size_t most_groups = 8;
/// Metres; closer to the eye than this no depths are told apart.
constexpr float least_depth = 1e-6f;

/// Seconds for which what drifts is taken to go on as its layer does.
constexpr float drifting_seconds = 0.1f;
/// Seconds after which nobody knows what deforms, however it does at present.
constexpr float most_followed_seconds = 0.8f;
/// Seconds of scene time less than which a drift is followed briefly: of the moments that what moves is held by none
/// would show it for longer.
constexpr float brief_seconds = 0.2f;

/// Radians a second above which shadows that are too thin for a layer are not carried on: they would be dots.
constexpr float fastest_thin_swing = 6;

/// Samples that may share a layer: of one body, of shadows that pass, or the sky.
struct Group {
    BodyNumber body = static_body;
    bool is_shadow = false, sky = false;

    bool operator==(Group const&) const = default;
};

BodyNumber body_of(Framelet const& framelet, int sample) {
    return framelet.body.empty() ? static_body : framelet.body[static_cast<std::size_t>(sample)];
}

Drift drift_of(Framelet const& framelet, int sample) {
    return framelet.drift.empty() ? Drift{} : framelet.drift[static_cast<std::size_t>(sample)];
}

/// Metres a second by which two drifts differ, as a mean over `drifting_seconds`.
float difference(Drift const& a, Drift const& b) {
    return glm::length(a.velocity - b.velocity) +
           0.5f * drifting_seconds * glm::length(a.acceleration - b.acceleration);
}

/// Position of a sample (in Morton order) in its grid.
Vec2 place_of(int sample) {
    auto const i = static_cast<std::uint32_t>(sample);
    return {static_cast<float>(morton_x(i)), static_cast<float>(morton_y(i))};
}

/// The grid's plane as the layer states it: in pixels from the tile's corner.
Layer layer_of_plane(GridPlane const& plane, Group const& group, float spacing) {
    constexpr float middle = 0.5f * framelet_side;
    Layer layer;
    layer.at = plane.centre - middle * plane.dx - middle * plane.dy;
    layer.dx = plane.dx / spacing;
    layer.dy = plane.dy / spacing;
    layer.body = group.body;
    return layer;
}

class Fitter {
public:
    Fitter(Framelet const& framelet, float spacing, LayerTolerance const& tolerance, FrameletShape& shape);

    void fit() {
        shape_.layer_count = 0;
        shape_.layers = {};
        shape_.outliers.clear();
        if (!(is_uniform() && fit_one())) {
            layer_of_.fill(FrameletShape::outlier);
            make_groups();
            fit_groups();
            take_isolated();
            collect();
        }
    }

private:
    bool is_uniform() const {
        bool const one_body = std::ranges::all_of(framelet_.body, [&](BodyNumber b) { return b == framelet_.body[0]; });
        return one_body && framelet_.drift.empty();
    }
    bool fit_one();
    void make_groups();
    void fit_groups();
    void set_candidates(std::size_t group);
    bool has_drift(std::size_t group) const { return !framelet_.drift.empty() && !groups_[group].sky; }
    void agree_on_drift(Group const& group);
    void fit_drift();
    void drop_useless_drift();
    SwingCode common_swing() const;
    float jerk_for(float seconds) const;
    void add_found(std::size_t group);
    void add_layer(GridPlane const& plane, float half_width, Group const& group);
    float error_of(Layer const& layer, float half_width) const;
    void take_isolated();
    float off_drift(LayerDrift const& drift, int sample) const;
    bool is_member(int sample) const { return found_.members[block_order(sample)] != 0; }
    std::uint8_t nearest_layer(int at) const;
    void collect();

    Framelet const& framelet_;
    float spacing_, tolerance_, velocity_tolerance_;
    float pixel_; ///< side of a pixel at depth 1, metres
    GridFloats values_; ///< inverse depths
    std::array<Group, most_groups> groups_;
    std::size_t group_count_ = 0;
    /// Group and layer of each sample, in block order as all grids here; group `most_groups`: in none.
    std::array<std::uint8_t, framelet_samples> group_of_, layer_of_;
    GridFloats candidates_;
    FoundPlane found_;
    LayerDrift drift_; ///< of what was found
    std::array<GridPlane, max_layers> planes_; ///< of the layers, and which group each is of
    std::array<std::size_t, max_layers> layer_groups_{};
    FrameletShape& shape_;
};

Fitter::Fitter(Framelet const& framelet, float spacing, LayerTolerance const& tolerance, FrameletShape& shape)
    : framelet_(framelet), spacing_(spacing), velocity_tolerance_(tolerance.velocity * std::max(1.0f, spacing)),
      pixel_(tolerance.velocity * drifting_seconds / tolerated_pixels), shape_(shape) {
    std::array<float, framelet_samples> inverse;
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        float const depth = framelet.depth[i];
        inverse[i] = 1 / (depth > least_depth ? depth : least_depth);
    }
    to_block_order(inverse, values_);
    constexpr float resolution = 1e-6f; // of sums of single-precision numbers
    tolerance_ = std::max(tolerance.inverse_depth * std::max(1.0f, spacing), resolution * greatest(values_));
}

bool Fitter::fit_one() {
    FittedPlane const fitted = fit_plane_to_all(values_);
    if (!(fitted.half_width <= tolerance_)) {
        return false;
    }
    add_layer(fitted.plane, fitted.half_width, {body_of(framelet_, 0), false, false});
    shape_.layer_of.fill(0);
    return true;
}

void Fitter::make_groups() {
    if (framelet_.body.empty() && framelet_.drift.empty()) {
        groups_ = {Group{}, Group{static_body, false, true}};
        for (int i = 0; i < framelet_samples; ++i) {
            group_of_[static_cast<std::size_t>(i)] = values_[i] == 0 ? 1 : 0;
        }
        return;
    }
    for (int i = 0; i < framelet_samples; ++i) {
        bool const sky = values_[block_order(i)] == 0;
        BodyNumber const body = sky ? static_body : body_of(framelet_, i);
        Group const group{body, !sky && is_shadow(body, drift_of(framelet_, i)), sky};
        std::size_t g = 0;
        while (g < group_count_ && groups_[g] != group) {
            ++g;
        }
        if (g == group_count_ && g < most_groups) {
            groups_[group_count_++] = group;
        }
        group_of_[static_cast<std::size_t>(block_order(i))] = static_cast<std::uint8_t>(g);
    }
}

/// Makes the samples of the group that are on no layer yet candidates.
void Fitter::set_candidates(std::size_t group) {
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        bool const is_group = group_of_[i] == group, is_free = layer_of_[i] == FrameletShape::outlier;
        candidates_.value[i] = static_cast<float>(int{is_group} & int{is_free});
    }
}

/// How far a sample (in Morton order) goes otherwise than its layer does, as of `LayerTolerance::velocity`.
float Fitter::off_drift(LayerDrift const& drift, int sample) const {
    Vec2 const from_corner = (place_of(sample) + 0.5f) * spacing_;
    return difference(drift.at(from_corner), drift_of(framelet_, sample)) * values_[block_order(sample)];
}

/// Fits the drift of the members by least squares, affine in the grid; the same everywhere where they lie in one line.
void Fitter::fit_drift() {
    float count = 0;
    Vec2 mean(0);
    Drift sum;
    for (int i = 0; i < framelet_samples; ++i) {
        if (is_member(i)) {
            Drift const own = drift_of(framelet_, i);
            count += 1;
            mean += place_of(i);
            sum.velocity += own.velocity;
            sum.acceleration += own.acceleration;
        }
    }
    mean /= count;
    drift_ = {};
    Drift const middle{sum.velocity / count, sum.acceleration / count};
    float xx = 0, xy = 0, yy = 0;
    std::array<Drift, 2> moments;
    for (int i = 0; i < framelet_samples; ++i) {
        if (is_member(i)) {
            Drift const own = drift_of(framelet_, i);
            Vec2 const from = place_of(i) - mean;
            xx += from.x * from.x;
            xy += from.x * from.y;
            yy += from.y * from.y;
            for (int axis = 0; axis < 2; ++axis) {
                Drift& moment = moments[static_cast<std::size_t>(axis)];
                moment.velocity += from[axis] * (own.velocity - middle.velocity);
                moment.acceleration += from[axis] * (own.acceleration - middle.acceleration);
            }
        }
    }
    float const determinant = xx * yy - xy * xy;
    constexpr float least_spread = 0.05f; // what lies nearly in a line says nothing of what is beside it
    if (determinant > least_spread * (xx + yy) * (xx + yy) / 4) {
        float const share = 1 / (determinant * spacing_);
        auto const solve = [&](auto part, Vec3& dx, Vec3& dy) {
            dx = share * (yy * (moments[0].*part) - xy * (moments[1].*part));
            dy = share * (xx * (moments[1].*part) - xy * (moments[0].*part));
        };
        solve(&Drift::velocity, drift_.velocity_dx, drift_.velocity_dy);
        solve(&Drift::acceleration, drift_.acceleration_dx, drift_.acceleration_dy);
    }
    Vec2 const at = (mean + 0.5f) * spacing_;
    drift_.corner.velocity = middle.velocity - at.x * drift_.velocity_dx - at.y * drift_.velocity_dy;
    drift_.corner.acceleration = middle.acceleration - at.x * drift_.acceleration_dx - at.y * drift_.acceleration_dy;
}

/// Fits a drift to the members and keeps those that it holds for. It is fitted to those that are nearer to it than
/// most, so that a few that go quite otherwise do not bend it.
void Fitter::agree_on_drift(Group const& group) {
    constexpr int most_fits = 3;
    GridFloats const all = found_.members;
    float most = 0; // as of `LayerTolerance::velocity`
    for (int fits = 1; found_.count > 0 && fits <= most_fits; ++fits) {
        fit_drift();
        std::array<float, framelet_samples> offs;
        auto end = offs.begin();
        for (int i = 0; i < framelet_samples; ++i) {
            if (all[block_order(i)] != 0) {
                *end++ = off_drift(drift_, i);
            }
        }
        auto const middle = offs.begin() + (end - offs.begin()) / 2;
        std::nth_element(offs.begin(), middle, end);
        bool const is_last = fits == most_fits || *std::max_element(middle, end) <= velocity_tolerance_;
        most = is_last ? velocity_tolerance_ : std::max(velocity_tolerance_, *middle);
        found_.count = 0;
        for (int i = 0; i < framelet_samples; ++i) {
            int const at = block_order(i);
            found_.members.value[static_cast<std::size_t>(at)] =
                all[at] != 0 && off_drift(drift_, i) <= most ? 1.0f : 0.0f;
            found_.count += is_member(i) ? 1 : 0;
        }
        if (is_last) {
            break;
        }
    }
    drift_.corner.swing = common_swing();
    float const square = swing_rate(drift_.corner.swing) * swing_rate(drift_.corner.swing);
    // Nine in ten have no more jerk: a sample at a joint does not shorten the life of all.
    std::array<float, framelet_samples> jerks;
    auto end = jerks.begin();
    for (int i = 0; i < framelet_samples; ++i) {
        if (is_member(i)) {
            Drift const own = drift_of(framelet_, i);
            float const rate = swing_rate(own.swing);
            *end++ = own.jerk + std::abs(rate * rate - square) * glm::length(own.velocity);
        }
    }
    if (end != jerks.begin()) {
        auto const high = jerks.begin() + (end - jerks.begin()) * 9 / 10;
        std::nth_element(jerks.begin(), high, end);
        drift_.corner.jerk = *high;
        if (!group.is_shadow) { // which would count as a part of the ground
            drop_useless_drift();
        }
        if (*high > 0) {
            drift_.corner.jerk = std::max(drift_.corner.jerk, jerk_for(most_followed_seconds));
        }
    }
}

/// The middle one of the swings of the members.
SwingCode Fitter::common_swing() const {
    std::array<SwingCode, framelet_samples> swings{};
    auto end = swings.begin();
    for (int i = 0; i < framelet_samples; ++i) {
        if (is_member(i)) {
            *end++ = drift_of(framelet_, i).swing;
        }
    }
    auto const middle = swings.begin() + (end - swings.begin()) / 2;
    std::nth_element(swings.begin(), middle, end);
    return *middle;
}

/// The jerk of which the framelet's nearest samples are followed for so long.
float Fitter::jerk_for(float seconds) const {
    return most_straying * pixel_ * 6 / (seconds * seconds * seconds * greatest(values_));
}

/// Drops the drift of what goes with its body so nearly that nobody sees a difference for twice `drifting_seconds`.
void Fitter::drop_useless_drift() {
    constexpr float unseen = 0.25f; // of the tolerance
    float most = 0;
    for (int i = 0; i < framelet_samples; ++i) {
        if (is_member(i)) {
            most = std::max(most, off_drift({}, i));
        }
    }
    float const nearest = greatest(values_);
    float const seconds = 2 * drifting_seconds;
    if (most <= unseen * velocity_tolerance_ &&
        drift_.corner.jerk * nearest * seconds * seconds / 6 <= unseen * velocity_tolerance_) {
        drift_ = {};
    }
}

/// The largest group gives the next layer, until there are enough or nothing is left that makes one.
void Fitter::fit_groups() {
    std::array<int, most_groups + 1> counts{};
    for (std::uint8_t const group : group_of_) {
        ++counts[group];
    }
    std::span const left = std::span(counts).first<most_groups>();
    while (shape_.layer_count < max_layers) {
        auto const largest = std::ranges::max_element(left);
        if (*largest < least_plane_samples) {
            break;
        }
        auto const g = static_cast<std::size_t>(largest - left.begin());
        Group const& group = groups_[g];
        set_candidates(g);
        find_plane(values_, candidates_, tolerance_, found_);
        drift_ = {};
        if (found_.count > 0 && has_drift(g)) {
            agree_on_drift(group);
        }
        if (found_.count < least_plane_samples) {
            *largest = 0; // what is left of it stays outliers
            continue;
        }
        add_found(g);
        *largest -= found_.count;
    }
}

/// Adds a layer of the members that were found, with even errors to both sides.
void Fitter::add_found(std::size_t group) {
    Range const range = residual_range(values_, found_.members, found_.plane);
    found_.plane.centre += range.middle();
    std::uint8_t const layer = shape_.layer_count; // a copy: bytes written below might alias the original
    for (std::size_t i = 0; i < framelet_samples; ++i) {
        layer_of_[i] = found_.members.value[i] != 0 ? layer : layer_of_[i];
    }
    planes_[layer] = found_.plane;
    layer_groups_[layer] = group;
    add_layer(found_.plane, range.half_width(), groups_[group]);
}

void Fitter::add_layer(GridPlane const& plane, float half_width, Group const& group) {
    Layer layer = layer_of_plane(plane, group, spacing_);
    layer.drift = drift_;
    layer.error = error_of(layer, half_width);
    shape_.layers[shape_.layer_count++] = layer;
}

/// Error of a layer whose samples are off by up to `half_width`, with a margin: the same plane in other coordinates, or
/// in another order of operations, rounds otherwise.
float Fitter::error_of(Layer const& layer, float half_width) const {
    constexpr float rounding = 2e-6f;
    float const side = spacing_ * framelet_side;
    float const magnitude = std::abs(layer.at) + side * (std::abs(layer.dx) + std::abs(layer.dy));
    return half_width + rounding * (magnitude + half_width);
}

/// The layer of its group that a sample is nearest to; `outlier` where none is near.
std::uint8_t Fitter::nearest_layer(int at) const {
    float least = isolated_tolerances * tolerance_;
    std::uint8_t nearest = FrameletShape::outlier;
    for (std::uint8_t l = 0; l < shape_.layer_count; ++l) {
        float const off = std::abs(residual(values_, planes_[l], at));
        if (layer_groups_[l] == group_of_[static_cast<std::size_t>(at)] && off <= least) {
            least = off;
            nearest = l;
        }
    }
    return nearest;
}

/// Puts samples that are left on no layer on the nearest one, one by one, if they are near and move as that does.
void Fitter::take_isolated() {
    std::array<float, max_layers> half_widths{};
    for (int i = 0; i < framelet_samples; ++i) {
        int const at = block_order(i);
        std::uint8_t& layer_of = layer_of_[static_cast<std::size_t>(at)];
        std::uint8_t const l = layer_of == FrameletShape::outlier ? nearest_layer(at) : FrameletShape::outlier;
        if (l == FrameletShape::outlier ||
            off_drift(shape_.layers[l].drift, i) > isolated_tolerances * velocity_tolerance_) {
            continue;
        }
        layer_of = l;
        half_widths[l] = std::max(half_widths[l], std::abs(residual(values_, planes_[l], at)));
    }
    for (std::size_t l = 0; l < shape_.layer_count; ++l) {
        Layer& layer = shape_.layers[l];
        layer.error = std::max(layer.error, error_of(layer, half_widths[l]));
    }
}

void Fitter::collect() {
    for (std::size_t block = 0; block < grid_blocks; ++block) {
        for (std::size_t i = 0; i < block_samples; ++i) {
            shape_.layer_of[block * block_samples + i] = layer_of_[i * grid_blocks + block];
        }
    }
    bool const any_shadow = std::ranges::any_of(shape_.layers, [](Layer const& layer) {
        return is_shadow(layer.body, layer.drift); // those beyond the last one are empty
    });
    for (int i = 0; i < framelet_samples; ++i) {
        if (shape_.layer_of[static_cast<std::size_t>(i)] == FrameletShape::outlier) {
            BodyNumber const body = body_of(framelet_, i);
            Drift const drift = drift_of(framelet_, i);
            bool const is_thin = !any_shadow && is_shadow(body, drift) && swing_rate(drift.swing) > fastest_thin_swing;
            shape_.outliers.push_back({values_[block_order(i)], body, is_thin ? Drift{} : drift});
        }
    }
}

} // namespace

LayerTolerance layer_tolerance(float median_depth, ViewRays const& rays, float speed) {
    constexpr float parallax = 20, seconds = 0.1f;
    constexpr float preferred_pixels = 0.1f, ahead = 0.2f;
    float const pixel = glm::length(rays.direction_dx);
    LayerTolerance tolerance{tolerated_pixels / (parallax * median_depth), tolerated_pixels * pixel / seconds, 0};
    float const travel = std::min(speed * ahead, median_depth); // farther than that is a jump
    float const preferred = travel > 0 ? preferred_pixels * pixel / travel : INFINITY;
    if (preferred < 0.5f * tolerance.inverse_depth) { // else it is not worth the search
        tolerance.preferred_inverse_depth = preferred;
    }
    return tolerance;
}

bool drifts_briefly(Framelet const& framelet, ImagePlane const& plane, FrameletShape const& shape, float focal) {
    float const middle = 0.5f * static_cast<float>(plane.tile_side(framelet.tile));
    int brief = 0, moving = 0;
    auto const count = [&](bool moves, float jerk, float inverse_depth) {
        bool const is_short = followed_seconds(jerk, inverse_depth * focal) < brief_seconds;
        return std::pair(moves ? 1 : 0, is_short ? 1 : 0);
    };
    std::array<std::pair<int, int>, max_layers> of_layer;
    for (std::size_t l = 0; l < shape.layer_count; ++l) {
        Layer const& layer = shape.layers[l];
        of_layer[l] =
            count(moves(layer.body, layer.drift), layer.drift.corner.jerk, layer.at + middle * (layer.dx + layer.dy));
    }
    auto outlier = shape.outliers.begin();
    for (std::uint8_t const layer : shape.layer_of) {
        auto const [one_moves, one_is_brief] =
            layer == FrameletShape::outlier
                ? count(moves(outlier->body, outlier->drift), outlier->drift.jerk, outlier->inverse_depth)
                : of_layer[layer];
        outlier += layer == FrameletShape::outlier ? 1 : 0;
        moving += one_moves;
        brief += one_is_brief;
    }
    return 2 * brief > moving;
}

float median_depth(std::span<Framelet const> framelets) {
    constexpr std::size_t step = 17; // odd: every position in the blocks is met
    constexpr std::size_t most_framelets = 64;
    std::size_t const stride = std::max<std::size_t>(framelets.size() / most_framelets, 1);
    std::vector<float> depths;
    for (std::size_t f = 0; f < framelets.size(); f += stride) {
        for (std::size_t i = 0; i < framelet_samples; i += step) {
            if (std::isfinite(framelets[f].depth[i])) {
                depths.push_back(framelets[f].depth[i]);
            }
        }
    }
    if (depths.empty()) {
        return 1;
    }
    auto const middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::ranges::nth_element(depths, middle);
    return std::max(*middle, least_depth);
}

void fit_layers(Framelet const& framelet, ImagePlane const& plane, LayerTolerance const& tolerance,
                FrameletShape& shape) {
    float const spacing = plane.sample_spacing(framelet.tile);
    std::array const all{tolerance.preferred_inverse_depth, tolerance.inverse_depth,
                         wide_tolerances * tolerance.inverse_depth};
    for (float const off : std::span(all).subspan(tolerance.preferred_inverse_depth > 0 ? 0 : 1)) {
        Fitter(framelet, spacing, {off, tolerance.velocity, 0}, shape).fit();
        if (shape.outliers.size() <= most_outliers) {
            return;
        }
    }
}

} // namespace framelet
