#include "server/stream/layers/layer_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>

#include "server/stream/layers/plane_search.h"

namespace framelet {
namespace {

/// The largest number of groups of samples that are told apart in a framelet; samples of further groups are outliers.
constexpr std::size_t most_groups = 8;
/// Metres; closer to the eye than this no depths are told apart.
constexpr float least_depth = 1e-6f;

/// Samples that may share a layer: of one body, or what deforms, or the sky.
struct Group {
    BodyNumber body = static_body;
    bool flows = false, sky = false;

    bool operator==(Group const&) const = default;
};

BodyNumber body_of(Framelet const& framelet, int sample) {
    return framelet.body.empty() ? static_body : framelet.body[static_cast<std::size_t>(sample)];
}

Vec3 velocity_of(Framelet const& framelet, int sample) {
    return framelet.velocity.empty() ? Vec3(0) : framelet.velocity[static_cast<std::size_t>(sample)];
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
        return one_body && framelet_.velocity.empty();
    }
    bool fit_one();
    void make_groups();
    void fit_groups();
    void set_candidates(std::size_t group);
    void agree_on_velocity();
    void add_found(std::size_t group);
    void add_layer(GridPlane const& plane, float half_width, Group const& group);
    float error_of(Layer const& layer, float half_width) const;
    void take_isolated();
    bool moves_with(Vec3 velocity, int sample, float tolerances = 1) const;
    Vec3 median_velocity();
    std::uint8_t nearest_layer(int at) const;
    void collect();

    Framelet const& framelet_;
    float spacing_, tolerance_, velocity_tolerance_;
    GridFloats values_; ///< inverse depths
    std::array<Group, most_groups> groups_;
    std::size_t group_count_ = 0;
    /// Group and layer of each sample, in block order as all grids here; group `most_groups`: in none.
    std::array<std::uint8_t, framelet_samples> group_of_, layer_of_;
    GridFloats candidates_;
    FoundPlane found_;
    Vec3 velocity_{0}; ///< velocity of what was found
    std::array<GridPlane, max_layers> planes_; ///< of the layers, and which group each is of
    std::array<std::size_t, max_layers> layer_groups_{};
    FrameletShape& shape_;
};

Fitter::Fitter(Framelet const& framelet, float spacing, LayerTolerance const& tolerance, FrameletShape& shape)
    : framelet_(framelet), spacing_(spacing), velocity_tolerance_(tolerance.velocity * std::max(1.0f, spacing)),
      shape_(shape) {
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
    if (framelet_.body.empty() && framelet_.velocity.empty()) {
        groups_ = {Group{}, Group{static_body, false, true}};
        for (int i = 0; i < framelet_samples; ++i) {
            group_of_[static_cast<std::size_t>(i)] = values_[i] == 0 ? 1 : 0;
        }
        return;
    }
    for (int i = 0; i < framelet_samples; ++i) {
        bool const sky = values_[block_order(i)] == 0;
        Group const group = sky ? Group{static_body, false, true}
                                : Group{body_of(framelet_, i), velocity_of(framelet_, i) != Vec3(0), false};
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

/// True where a sample (in Morton order) moves at nearly this velocity.
bool Fitter::moves_with(Vec3 velocity, int sample, float tolerances) const {
    float const off = glm::length(velocity_of(framelet_, sample) - velocity) * values_[block_order(sample)];
    return off <= tolerances * velocity_tolerance_;
}

/// Median velocity of what was found, each component by itself: those few that move quite otherwise do not bend it.
Vec3 Fitter::median_velocity() {
    Vec3 median(0);
    for (int axis = 0; axis < 3; ++axis) {
        std::array<float, framelet_samples> values;
        auto end = values.begin();
        for (int i = 0; i < framelet_samples; ++i) {
            if (found_.members[block_order(i)] != 0) {
                *end++ = velocity_of(framelet_, i)[axis];
            }
        }
        auto const middle = values.begin() + (end - values.begin()) / 2;
        std::nth_element(values.begin(), middle, end);
        median[axis] = *middle;
    }
    return median;
}

/// Keeps the members that move nearly as most do. At least one was found.
void Fitter::agree_on_velocity() {
    velocity_ = median_velocity();
    found_.count = 0;
    for (int i = 0; i < framelet_samples; ++i) {
        float& member = found_.members[block_order(i)];
        member = member != 0 && moves_with(velocity_, i) ? 1.0f : 0.0f;
        found_.count += member != 0 ? 1 : 0;
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
        velocity_ = Vec3(0);
        if (group.flows && found_.count > 0) {
            agree_on_velocity();
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
    layer.velocity = velocity_;
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
        if (l == FrameletShape::outlier || !moves_with(shape_.layers[l].velocity, i, isolated_tolerances)) {
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
    for (int i = 0; i < framelet_samples; ++i) {
        if (shape_.layer_of[static_cast<std::size_t>(i)] == FrameletShape::outlier) {
            shape_.outliers.push_back({values_[block_order(i)], body_of(framelet_, i), velocity_of(framelet_, i)});
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
