#include "common/warp/framelet_warp.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "common/framelet/sample_worth.h"
#include "common/mix_bits.h"

namespace framelet {

namespace {

/// The bounds of a splat's radius, pixels: a smaller one would vanish between pixels' centres.
constexpr double smallest_splat = 0.75;
constexpr double largest_splat = 32;

/// Numbers as large as this, and what is not a number, do not get into a patch.
constexpr double largest = 1e18;

/// Factor of the worn spacing of what leads: nothing else is as good.
constexpr float ahead_of_all = 1.0f / 64;
/// Factor of the worn spacing of what is out of date: all that is not is better.
constexpr float behind_all = 2 * worst_worn;

/// Order-dependent hash of what a patch is made of.
class Signature {
public:
    void add(std::uint64_t value) { state_ = mix_in(state_, value); }
    void add(float a, float b) {
        add(std::uint64_t{std::bit_cast<std::uint32_t>(a)} << 32 | std::bit_cast<std::uint32_t>(b));
    }
    std::uint64_t value() const { return state_; }

private:
    std::uint64_t state_ = 0x243f6a8885a308d3u;
};

std::uint64_t signature_of(WarpPatch const& patch, std::uint64_t content, std::span<Splat const> splats) {
    Signature out;
    out.add(content);
    out.add(std::uint64_t{patch.tile_layer} << 32 | static_cast<std::uint32_t>(patch.side));
    out.add(patch.at[0], patch.at[1]);
    out.add(patch.dx[0], patch.dx[1]);
    out.add(patch.dy[0], patch.dy[1]);
    out.add(patch.at[2], patch.dx[2]);
    out.add(patch.dy[2], patch.inverse_depth);
    out.add(patch.inverse_depth_dx, patch.inverse_depth_dy);
    out.add(std::uint64_t(static_cast<std::uint32_t>(patch.box.left)) << 32 |
            static_cast<std::uint32_t>(patch.box.top));
    for (Splat const& splat : splats) {
        out.add(splat.x, splat.y);
        out.add(splat.inverse_depth, splat.spacing);
    }
    return out.value();
}

bool is_usable(Layer const& layer) {
    auto const is_small = [](float value) { return std::abs(value) < static_cast<float>(largest); };
    auto const is_short = [&](Vec3 const& v) { return is_small(v.x) && is_small(v.y) && is_small(v.z); };
    LayerDrift const& drift = layer.drift;
    return is_small(layer.at) && is_small(layer.dx) && is_small(layer.dy) && is_small(layer.error) &&
           is_short(drift.corner.velocity) && is_short(drift.velocity_dx) && is_short(drift.velocity_dy) &&
           is_short(drift.corner.acceleration) && is_short(drift.acceleration_dx) && is_short(drift.acceleration_dy);
}

bool is_usable(WarpPatch const& patch) {
    bool usable = true;
    for (float const value :
         {patch.at[0], patch.at[1], patch.at[2], patch.dx[0], patch.dx[1], patch.dx[2], patch.dy[0], patch.dy[1],
          patch.dy[2], patch.inverse_depth, patch.inverse_depth_dx, patch.inverse_depth_dy, patch.tolerance}) {
        usable &= std::abs(value) < static_cast<float>(largest);
    }
    return usable;
}

} // namespace

FrameletWarp::FrameletWarp(FrameletCache const& cache, std::size_t slot, SlotRole role, Camera const& display,
                           SceneTime time, BodyMotions const& motions)
    : cache_(cache), slot_(slot), role_(role), display_(display),
      display_rays_(make_view_rays(display, cache.plane().viewport())), time_(time),
      valid_(motions.between_jumps(time)), motions_(motions) {}

void FrameletWarp::add(CachedFramelet const& framelet, unsigned parts, std::vector<WarpPatch>& patches,
                       std::vector<Splat>& splats) {
    HeldShape const& shape = framelet.shape;
    WarpPatch common;
    common.side = common.stride = shape.side;
    common.grid = shape.side == framelet_side ? framelet.samples.data() : shape.reduced.data();
    common.group = group_of(slot_, framelet.view, framelet.tile.depth());
    common.batch = framelet.moment.batch;
    rect_ = cache_.plane().tile_rect(framelet.tile);
    spacing_ = static_cast<double>(rect_.width()) / shape.side;
    for (std::uint32_t i = 0; i < shape.layer_count; ++i) {
        if ((parts >> i & 1) == 0) {
            continue;
        }
        WarpPatch patch = common;
        patch.layer = i;
        patch.ends_before[0] = shape.layers[i].ends_before;
        patch.has_ends = patch.ends_before[0] != 0;
        patch.tile_layer = framelet.tile.code * 4 + i;
        add_layer(framelet.view, shape.layers[i], shape.decorrelation, framelet.moment.batch, patch, patches);
    }
    if ((parts >> FrameletShape::outlier & 1) != 0 && !shape.outliers.empty()) {
        common.is_outlier = true;
        common.layer = FrameletShape::outlier;
        common.tile_layer = framelet.tile.code * 4 + FrameletShape::outlier;
        common.first_splat = static_cast<std::uint32_t>(splats.size());
        add_splats(framelet, common, splats);
        common.splats = static_cast<std::uint32_t>(splats.size()) - common.first_splat;
        float moved = 0; // mean spacing
        for (Splat const& splat : std::span(splats).subspan(common.first_splat)) {
            moved += splat.spacing / static_cast<float>(common.splats);
        }
        float const spacing = std::max(moved, static_cast<float>(spacing_));
        common.worn = worn(framelet.view, shape.decorrelation, spacing, 0, common.is_still);
        if (!common.box.empty()) {
            common.signature =
                signature_of(common, framelet.moment.batch, std::span(splats).subspan(common.first_splat));
            patches.push_back(common);
        }
    }
}

void FrameletWarp::add(MergedLayer const& merged, std::vector<WarpPatch>& patches) {
    WarpPatch patch;
    patch.grid = merged.grid;
    patch.side = merged.side;
    patch.stride = merged.stride;
    patch.group = group_of(slot_, merged.view, merged.first.depth());
    patch.batch = merged.newest_batch;
    patch.layer = merged.number;
    patch.ends_before = merged.ends_before;
    patch.has_ends = std::ranges::any_of(merged.ends_before, [](std::uint32_t bits) { return bits != 0; });
    patch.occupied = merged.occupied;
    patch.tile_layer = merged.first.code * 4 + merged.first_layer;
    rect_ = cache_.plane().tile_rect(merged.tile);
    spacing_ = static_cast<double>(rect_.width()) / merged.side;
    add_layer(merged.view, merged.layer, merged.decorrelation, merged.signature, patch, patches);
}

void FrameletWarp::add_layer(std::uint32_t view, HeldLayer const& layer, DecorrelationCode decorrelation,
                             std::uint64_t content, WarpPatch& patch, std::vector<WarpPatch>& patches) {
    if (layer.last_column < layer.first_column || !is_usable(layer.layer)) {
        return;
    }
    turn_to(view, layer);
    if ((is_still_ ? project_still(layer, patch) : project(layer, patch)) && is_usable(patch)) {
        rate(view, decorrelation, layer.layer, patch);
        patch.signature = signature_of(patch, content, {});
        patches.push_back(patch);
    }
}

/// The worn spacing of samples in steps, as `worn_step` has it; limits `lasts_` to the times for which the step is the
/// same.
float FrameletWarp::worn(std::uint32_t view, DecorrelationCode decorrelation, float spacing, float misplaced,
                         bool still) {
    SceneTime const rendered = cache_.views()[view].scene_time;
    float const rate = still ? 0 : decorrelation_rate(decorrelation);
    float const fresh = worn_spacing(spacing, 0, rate) + misplaced;
    float const step = worn_step(worn_spacing(spacing, static_cast<float>(time_ - rendered), rate) + misplaced);
    if (rate > 0) {
        constexpr float rounding = 1e-6f;
        auto const [low, high] = worn_of_step(step);
        auto const since = static_cast<double>((low * (1 + rounding) - fresh) / rate);
        auto const until = static_cast<double>((high * (1 - rounding) - fresh) / rate);
        bool const both = !(since > 0); // also before it was rendered
        lasts_.first = std::max(lasts_.first, rendered + (both || time_ < rendered ? -until : since));
        lasts_.last = std::min(lasts_.last, rendered + (both || time_ >= rendered ? until : -since));
    }
    return valid_.contains(rendered) ? step : behind_all * step;
}

void FrameletWarp::rate(std::uint32_t view, DecorrelationCode decorrelation, Layer const& layer, WarpPatch& patch) {
    float const x = 0.5f * static_cast<float>(patch.box.width());
    float const y = 0.5f * static_cast<float>(patch.box.height());
    auto const at = [&](std::size_t i) { return patch.at[i] + x * patch.dx[i] + y * patch.dy[i]; };
    float const z = at(2);
    float const u = at(0) / z;
    float const v = at(1) / z;
    // Samples a pixel, from the derivatives there; the direction in which they are farthest apart counts.
    float const ux = (patch.dx[0] - u * patch.dx[2]) / z, uy = (patch.dy[0] - u * patch.dy[2]) / z;
    float const vx = (patch.dx[1] - v * patch.dx[2]) / z, vy = (patch.dy[1] - v * patch.dy[2]) / z;
    float const squares = ux * ux + uy * uy + vx * vx + vy * vy;
    float const area = ux * vy - uy * vx;
    float const least = 0.5f * (squares - std::sqrt(std::max(squares * squares - 4 * area * area, 0.0f)));
    float const spacing = 1 / std::sqrt(std::max(least, 1e-6f));
    // Pixels by which its samples may be shown off their positions: their inverse depths are not quite the plane's.
    glm::dvec2 const middle = 0.5 * glm::dvec2(patch.box.left + patch.box.right, patch.box.top + patch.box.bottom);
    float const misplaced = is_still_ ? 0 : layer.error * z * parallax_at(middle);
    auto const age = static_cast<float>(time_ - cache_.views()[view].scene_time);
    float const inverse_depth = patch.inverse_depth + x * patch.inverse_depth_dx + y * patch.inverse_depth_dy;
    float const strayed =
        straying(layer.drift.corner.jerk, inverse_depth / glm::length(display_rays_.direction_dx), age);
    patch.worn = worn(view, decorrelation, spacing, misplaced + strayed, is_still_);
    if (is_shadow(layer.body, layer.drift)) {
        patch.group = drifting_group(patch.group);
        patch.worn *= leads(layer.body, layer.drift, age) ? ahead_of_all : 1.0f;
    }
    bool const is_replaced = role_.is_base; // by what is newer, in its place: else it may be anywhere
    patch.hides = hides(spacing, misplaced) && !is_adrift(layer.body, layer.drift, age) && (is_replaced || !is_lost_);
    if (is_astray(spacing, misplaced) || is_lost_) {
        patch.tolerance = static_cast<float>(largest); // it never counts as the nearer one
    }
}

float FrameletWarp::parallax_at(glm::dvec2 pixel) const {
    glm::dvec3 const& parallax = transform_.parallax;
    return static_cast<float>(glm::length(glm::dvec2(parallax) - pixel * parallax.z));
}

double FrameletWarp::inverse_depth_within(double pixels, MergedLayer const& merged) {
    HeldLayer const& held = merged.layer;
    Layer const& layer = held.layer;
    turn_to(merged.view, held);
    if (is_still_) {
        return 0;
    }
    PixelRect const rect = cache_.plane().tile_rect(merged.tile);
    double const spacing = static_cast<double>(rect.width()) / merged.side;
    glm::dvec2 const low = spacing * glm::dvec2(held.first_column, held.first_row);
    glm::dvec2 const high = spacing * glm::dvec2(held.last_column + 1, held.last_row + 1);
    glm::dvec2 const middle = 0.5 * (low + high);
    double const w = layer.at + layer.dx * middle.x + layer.dy * middle.y;
    glm::dvec3 const& parallax = transform_.parallax;
    double const dx = transform_.far[0].z + layer.dx * parallax.z;
    double const dy = transform_.far[1].z + layer.dy * parallax.z;
    double const z = transform_.map(rect.left + middle.x, rect.top + middle.y, w).z -
                     0.5 * (std::abs(dx) * (high.x - low.x) + std::abs(dy) * (high.y - low.y)); // the least z
    double const within = pixels * std::max(z, nearest_share) / parallax_;
    return within > 0 ? within : 0;
}

/// Seconds of scene time, of either sign, for which what is of this jerk and inverse depth has followed its drift; 0
/// once it is lost, which is noted.
float FrameletWarp::followed_age(std::uint32_t view, float jerk, double inverse_depth) {
    HeldView const& from = cache_.views()[view];
    auto const age = static_cast<float>(time_ - from.scene_time);
    is_lost_ = false;
    if (!(jerk > 0)) {
        return age;
    }
    ViewRays const rays = make_view_rays(from.camera, cache_.plane().viewport());
    float const seconds = followed_seconds(jerk, static_cast<float>(inverse_depth) / glm::length(rays.direction_dx));
    is_lost_ = std::abs(age) > seconds;
    return is_lost_ ? 0 : age;
}

glm::dvec2 FrameletWarp::middle(HeldLayer const& layer) const {
    return 0.5 * spacing_ *
           glm::dvec2(layer.first_column + layer.last_column + 1, layer.first_row + layer.last_row + 1);
}

void FrameletWarp::turn_to(std::uint32_t view, HeldLayer const& held) {
    Layer const& layer = held.layer;
    stretch_ = glm::dmat3(0);
    is_lost_ = false;
    if (!layer.drift.any()) {
        turn_to(view, layer.body, glm::dvec3(0));
        return;
    }
    lasts_ = {time_, -INFINITY};
    glm::dvec2 const at = middle(held);
    double const inverse_depth = layer.at + layer.dx * at.x + layer.dy * at.y;
    float const age = followed_age(view, layer.drift.corner.jerk, inverse_depth);
    turn_to(view, layer.body, glm::dvec3(layer.drift.at(Vec2(at)).after(age)));
    auto const after = [&](Vec3 const& velocity, Vec3 const& acceleration) {
        return glm::dvec3(Drift{velocity, acceleration, 0, layer.drift.corner.swing}.after(age));
    };
    if (!is_still_) {
        stretch_ = make_stretch(layer, display_rays_, at, after(layer.drift.velocity_dx, layer.drift.acceleration_dx),
                                after(layer.drift.velocity_dy, layer.drift.acceleration_dy));
    }
}

/// `drift`: metres in the world, by the time that is shown.
void FrameletWarp::turn_to(std::uint32_t view, BodyNumber body, glm::dvec3 const& drift) {
    if (has_transform_ && view == view_ && body == body_ && drift == drift_) {
        return;
    }
    if (body != static_body) {
        lasts_ = {time_, -INFINITY};
    }
    has_transform_ = true;
    view_ = view;
    body_ = body;
    drift_ = drift;
    HeldView const& from = cache_.views()[view];
    Motion const motion = body == static_body ? Motion{} : motions_.between(body, from.scene_time, time_);
    is_still_ = !is_reprojectable(from.camera) || !is_reprojectable(display_) ||
                (from.camera == display_ && motion == Motion{} && drift == glm::dvec3(0));
    transform_ = is_still_ ? ViewTransform{}
                           : make_view_transform(make_view_rays(from.camera, cache_.plane().viewport()), display_rays_,
                                                 motion, drift);
    glm::dvec3 const& parallax = transform_.parallax;
    // A sample that is shown at X moves by (parallax.xy - X parallax.z) / z for each 1 / metre.
    Viewport const viewport = cache_.plane().viewport();
    double const x = std::max(std::abs(parallax.x), std::abs(parallax.x - viewport.width * parallax.z));
    double const y = std::max(std::abs(parallax.y), std::abs(parallax.y - viewport.height * parallax.z));
    parallax_ = std::max(std::hypot(x, y), 1 / largest);
    lens_ratio_ = std::sqrt(std::abs(glm::determinant(transform_.far)));
}

/// Corners of what the layer's samples cover, half a sample's cell more included; pixels from the tile's corner.
glm::dvec2 FrameletWarp::low(HeldLayer const& layer) const {
    return spacing_ * (glm::dvec2(layer.first_column, layer.first_row) - 0.5);
}

glm::dvec2 FrameletWarp::high(HeldLayer const& layer) const {
    return spacing_ * (glm::dvec2(layer.last_column, layer.last_row) + 1.5);
}

bool FrameletWarp::project_still(HeldLayer const& held, WarpPatch& patch) const {
    glm::dvec2 const corner(rect_.left, rect_.top);
    glm::dmat3 to_display(1);
    to_display[2] = glm::dvec3(corner, 1);
    patch.box = display_box(to_display, low(held), high(held), cache_.plane().viewport());
    if (patch.box.empty()) {
        return false;
    }
    PlaneTransform plane;
    plane.to_source = glm::dmat3(1);
    plane.to_source[2] = glm::dvec3(-corner, 1);
    plane.inverse_depth =
        glm::dvec3(held.layer.dx, held.layer.dy, held.layer.at - held.layer.dx * corner.x - held.layer.dy * corner.y);
    patch.is_still = true;
    patch.group = still_group(patch.group);
    set_maps(plane, patch);
    patch.tolerance = held.layer.error;
    return true;
}

bool FrameletWarp::project(HeldLayer const& held, WarpPatch& patch) const {
    auto const plane = make_plane_transform(transform_, held.layer, {rect_.left, rect_.top}, stretch_);
    if (!plane) {
        return false;
    }
    patch.box = display_box(plane->to_display, low(held), high(held), cache_.plane().viewport());
    if (patch.box.empty()) {
        return false;
    }
    set_maps(*plane, patch);
    glm::dvec3 const middle((patch.box.left + patch.box.right) / 2.0, (patch.box.top + patch.box.bottom) / 2.0, 1);
    double const inverse_z = std::max((plane->to_source * middle).z, nearest_share);
    patch.tolerance = static_cast<float>(held.layer.error * inverse_z);
    return true;
}

void FrameletWarp::set_maps(PlaneTransform const& plane, WarpPatch& patch) const {
    glm::dmat3 to_samples(1);
    to_samples[0].x = to_samples[1].y = 1 / spacing_;
    to_samples[2] = glm::dvec3(-0.5, -0.5, 1);
    glm::dmat3 const map = to_samples * plane.to_source;
    glm::dvec3 const first(patch.box.left + 0.5, patch.box.top + 0.5, 1);
    glm::dvec3 const at = map * first;
    for (int i = 0; i < 3; ++i) {
        auto const k = static_cast<std::size_t>(i);
        patch.at[k] = static_cast<float>(at[i]);
        patch.dx[k] = static_cast<float>(map[0][i]);
        patch.dy[k] = static_cast<float>(map[1][i]);
    }
    patch.inverse_depth = static_cast<float>(glm::dot(plane.inverse_depth, first));
    patch.inverse_depth_dx = static_cast<float>(plane.inverse_depth.x);
    patch.inverse_depth_dy = static_cast<float>(plane.inverse_depth.y);
}

void FrameletWarp::add_splats(CachedFramelet const& framelet, WarpPatch& patch, std::vector<Splat>& splats) {
    Viewport const viewport = cache_.plane().viewport();
    double left = viewport.width, top = viewport.height, right = 0, bottom = 0;
    bool still = true;
    for (HeldOutlier const& outlier : framelet.shape.outliers) {
        double const w = std::max(static_cast<double>(outlier.sample.inverse_depth), 0.0);
        Drift const& drift = outlier.sample.drift;
        if (drift.any()) {
            lasts_ = {time_, -INFINITY};
        }
        glm::dvec3 const drifted(drift.any() ? drift.after(followed_age(framelet.view, drift.jerk, w)) : Vec3(0));
        if (drift.any() && is_lost_ && !role_.is_base) {
            continue;
        }
        turn_to(framelet.view, outlier.sample.body, drifted);
        still = still && is_still_;
        int const column = outlier.index % patch.side, row = outlier.index / patch.side;
        glm::dvec3 const at =
            transform_.map(rect_.left + (column + 0.5) * spacing_, rect_.top + (row + 0.5) * spacing_, w);
        if (!(at.z > nearest_share)) {
            continue;
        }
        double const x = at.x / at.z;
        double const y = at.y / at.z;
        double const spacing = std::clamp(spacing_ * lens_ratio_ / at.z, smallest_splat, largest_splat);
        if (!(x + spacing > 0 && y + spacing > 0 && x - spacing < viewport.width && y - spacing < viewport.height)) {
            continue;
        }
        double const inverse_depth = w / at.z;
        if (!(inverse_depth < largest)) {
            continue;
        }
        splats.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(inverse_depth),
                          static_cast<float>(spacing), patch.grid[outlier.index]});
        left = std::min(left, x - spacing);
        top = std::min(top, y - spacing);
        right = std::max(right, x + spacing);
        bottom = std::max(bottom, y + spacing);
    }
    patch.is_still = still;
    patch.group = still ? still_group(patch.group) : patch.group;
    patch.box = {static_cast<int>(std::max(std::floor(left), 0.0)), static_cast<int>(std::max(std::floor(top), 0.0)),
                 std::min(static_cast<int>(std::ceil(right)), viewport.width),
                 std::min(static_cast<int>(std::ceil(bottom)), viewport.height)};
}

} // namespace framelet
