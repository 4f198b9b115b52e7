#include "common/warp_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tbb/parallel_for.h>

#include "common/reprojection.h"

namespace framelet {

namespace {

constexpr std::size_t slots_per_chunk = 256;
constexpr std::uint32_t patches_per_chunk = slots_per_chunk * (max_layers + 1);
constexpr int block_side = FrameletCache::block_side;

/// A sample nearer to the display camera than this share of its depth in the source is not drawn.
constexpr double nearest = 1e-3;

/// No splat is smaller (between pixels' centres it would vanish) or larger than this, pixels.
constexpr double smallest_splat = 0.75;
constexpr double largest_splat = 32;

/// Order-dependent hash of what a patch is made of.
class Signature {
public:
    void add(std::uint64_t value) {
        state_ = (state_ ^ value) * 0x9e3779b97f4a7c15u;
        state_ ^= state_ >> 32;
    }
    void add(float value) { add(std::uint64_t{std::bit_cast<std::uint32_t>(value)}); }
    std::uint64_t value() const { return state_; }

private:
    std::uint64_t state_ = 0x243f6a8885a308d3u;
};

std::uint64_t signature_of(WarpPatch const& patch, std::span<Splat const> splats) {
    Signature out;
    out.add(patch.batch);
    out.add(std::uint64_t{patch.place});
    for (int i = 0; i < 3; ++i) {
        auto const k = static_cast<std::size_t>(i);
        out.add(patch.at[k]);
        out.add(patch.dx[k]);
        out.add(patch.dy[k]);
    }
    out.add(patch.inverse_depth);
    out.add(patch.inverse_depth_dx);
    out.add(patch.inverse_depth_dy);
    out.add(std::uint64_t(static_cast<std::uint32_t>(patch.box.left)) << 32 |
            static_cast<std::uint32_t>(patch.box.top));
    for (Splat const& splat : splats) {
        out.add(splat.x);
        out.add(splat.y);
        out.add(splat.inverse_depth);
        out.add(splat.spacing);
    }
    return out.value();
}

/// Transforms one framelet after the other; neighbours mostly share view and body.
class FrameletWarp {
public:
    FrameletWarp(FrameletCache const& cache, Camera const& display, SceneTime time, BodyMotions const& motions)
        : cache_(cache), display_(display), display_rays_(make_view_rays(display, cache.plane().viewport())),
          time_(time), motions_(motions) {}

    void add(CachedFramelet const& framelet, std::vector<WarpPatch>& patches, std::vector<Splat>& splats) {
        HeldShape const& shape = framelet.shape;
        WarpPatch common;
        common.side = shape.side;
        common.grid = shape.side == framelet_side ? framelet.samples.data() : shape.reduced.data();
        common.group = static_cast<std::int32_t>(framelet.view) * 16 + framelet.tile.depth();
        common.batch = framelet.moment.batch;
        common.scene_time = framelet.moment.scene_time;
        rect_ = cache_.plane().tile_rect(framelet.tile);
        spacing_ = static_cast<double>(rect_.width()) / shape.side;
        for (std::uint32_t i = 0; i < shape.layer_count; ++i) {
            HeldLayer const& layer = shape.layers[i];
            if (layer.last_column < layer.first_column) {
                continue;
            }
            WarpPatch patch = common;
            patch.layer = i;
            patch.place = framelet.tile.code * 4 + i;
            turn_to(framelet.view, layer.layer.body, layer.layer.velocity);
            if (is_still_ ? place_still(layer, patch) : place(layer, patch)) {
                patch.signature = signature_of(patch, {});
                patches.push_back(patch);
            }
        }
        if (!shape.loose.empty()) {
            common.layer = FrameletShape::loose;
            common.place = framelet.tile.code * 4 + FrameletShape::loose;
            common.first_splat = static_cast<std::uint32_t>(splats.size());
            add_splats(framelet, common, splats);
            common.splats = static_cast<std::uint32_t>(splats.size()) - common.first_splat;
            if (!common.box.empty()) {
                common.signature = signature_of(common, std::span(splats).subspan(common.first_splat));
                patches.push_back(common);
            }
        }
    }

private:
    void turn_to(std::uint32_t view, BodyNumber body, Vec3 const& velocity) {
        if (has_transform_ && view == view_ && body == body_ && velocity == velocity_) {
            return;
        }
        has_transform_ = true;
        view_ = view;
        body_ = body;
        velocity_ = velocity;
        HeldView const& from = cache_.views()[view];
        Motion const motion = body == static_body ? Motion{} : motions_.between(body, from.scene_time, time_);
        glm::dvec3 const drift = (time_ - from.scene_time) * glm::dvec3(velocity);
        is_still_ = !is_reprojectable(from.camera) || !is_reprojectable(display_) ||
                    (from.camera == display_ && motion == Motion{} && drift == glm::dvec3(0));
        transform_ = is_still_ ? ViewTransform{}
                               : make_view_transform(make_view_rays(from.camera, cache_.plane().viewport()),
                                                     display_rays_, motion, drift);
        lens_ratio_ = std::sqrt(std::abs(glm::determinant(transform_.far)));
    }

    /// Where the layer's samples and half a sample's cell more reach, pixels from the tile's corner.
    glm::dvec2 low(HeldLayer const& layer) const {
        return spacing_ * (glm::dvec2(layer.first_column, layer.first_row) - 0.5);
    }
    glm::dvec2 high(HeldLayer const& layer) const {
        return spacing_ * (glm::dvec2(layer.last_column, layer.last_row) + 1.5);
    }

    bool place_still(HeldLayer const& held, WarpPatch& patch) const {
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
        plane.inverse_depth = glm::dvec3(held.layer.dx, held.layer.dy,
                                         held.layer.at - held.layer.dx * corner.x - held.layer.dy * corner.y);
        patch.is_still = true;
        set_maps(plane, patch);
        patch.tolerance = held.layer.error;
        return true;
    }

    bool place(HeldLayer const& held, WarpPatch& patch) const {
        auto const plane = make_plane_transform(transform_, held.layer, {rect_.left, rect_.top});
        if (!plane) {
            return false;
        }
        patch.box = display_box(plane->to_display, low(held), high(held), cache_.plane().viewport());
        if (patch.box.empty()) {
            return false;
        }
        set_maps(*plane, patch);
        glm::dvec3 const middle((patch.box.left + patch.box.right) / 2.0, (patch.box.top + patch.box.bottom) / 2.0, 1);
        double const inverse_z = std::max((plane->to_source * middle).z, nearest);
        patch.tolerance = static_cast<float>(held.layer.error * inverse_z);
        patch.stretch =
            static_cast<float>(std::abs(glm::determinant(plane->to_display)) * inverse_z * inverse_z * inverse_z);
        return true;
    }

    void set_maps(PlaneTransform const& plane, WarpPatch& patch) const {
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

    void add_splats(CachedFramelet const& framelet, WarpPatch& patch, std::vector<Splat>& splats) {
        Viewport const viewport = cache_.plane().viewport();
        double left = viewport.width, top = viewport.height, right = 0, bottom = 0;
        bool still = true;
        for (HeldLoose const& loose : framelet.shape.loose) {
            turn_to(framelet.view, loose.sample.body, loose.sample.velocity);
            still = still && is_still_;
            double const w = std::max(static_cast<double>(loose.sample.inverse_depth), 0.0);
            glm::dvec3 const at = transform_.map(rect_.left + (loose.place % patch.side + 0.5) * spacing_,
                                                 rect_.top + (loose.place / patch.side + 0.5) * spacing_, w);
            if (!(at.z > nearest)) {
                continue;
            }
            double const x = at.x / at.z;
            double const y = at.y / at.z;
            double const spacing = std::clamp(spacing_ * lens_ratio_ / at.z, smallest_splat, largest_splat);
            if (!(x + spacing > 0 && y + spacing > 0 && x - spacing < viewport.width &&
                  y - spacing < viewport.height)) {
                continue;
            }
            splats.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(w / at.z),
                              static_cast<float>(spacing), patch.grid[loose.place]});
            left = std::min(left, x - spacing);
            top = std::min(top, y - spacing);
            right = std::max(right, x + spacing);
            bottom = std::max(bottom, y + spacing);
            patch.stretch = static_cast<float>(spacing * spacing / (spacing_ * spacing_));
        }
        patch.is_still = still;
        patch.box = {static_cast<int>(std::max(std::floor(left), 0.0)),
                     static_cast<int>(std::max(std::floor(top), 0.0)),
                     std::min(static_cast<int>(std::ceil(right)), viewport.width),
                     std::min(static_cast<int>(std::ceil(bottom)), viewport.height)};
    }

    FrameletCache const& cache_;
    Camera const& display_;
    ViewRays display_rays_;
    SceneTime time_;
    BodyMotions const& motions_;

    PixelRect rect_; // of the framelet at hand
    double spacing_ = 1; // of its moving grid

    bool has_transform_ = false;
    std::uint32_t view_ = 0;
    BodyNumber body_ = static_body;
    Vec3 velocity_{0};
    bool is_still_ = false;
    ViewTransform transform_;
    double lens_ratio_ = 1;
};

template <class Visit>
void for_each_block(PixelRect const& box, int columns, Visit const& visit) {
    int const last_row = (box.bottom - 1) / block_side;
    int const last_column = (box.right - 1) / block_side;
    for (int row = box.top / block_side; row <= last_row; ++row) {
        for (int column = box.left / block_side; column <= last_column; ++column) {
            visit(static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column));
        }
    }
}

} // namespace

void WarpPlan::make(FrameletCache const& cache, Camera const& display, SceneTime display_time,
                    BodyMotions const& motions) {
    Viewport const viewport = cache.plane().viewport();
    columns_ = (viewport.width + block_side - 1) / block_side;
    rows_ = (viewport.height + block_side - 1) / block_side;
    chunks_.resize(cache.slot_count() / slots_per_chunk);
    tbb::parallel_for(std::size_t{0}, chunks_.size(), [&](std::size_t i) {
        Chunk& chunk = chunks_[i];
        chunk.patches.clear();
        chunk.splats.clear();
        FrameletWarp warp(cache, display, display_time, motions);
        for (std::size_t slot = i * slots_per_chunk; slot < (i + 1) * slots_per_chunk; ++slot) {
            if (CachedFramelet const* const framelet = cache.at_slot(slot)) {
                warp.add(*framelet, chunk.patches, chunk.splats);
            }
        }
    });
    make_bins();
}

void WarpPlan::make_bins() {
    std::size_t const blocks = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
    first_entry_.assign(blocks + 1, 0);
    for (Chunk const& chunk : chunks_) {
        for (WarpPatch const& patch : chunk.patches) {
            for_each_block(patch.box, columns_, [&](std::size_t block) { ++first_entry_[block + 1]; });
        }
    }
    for (std::size_t i = 0; i < blocks; ++i) {
        first_entry_[i + 1] += first_entry_[i];
    }
    entries_.resize(first_entry_.back());
    next_entry_.assign(first_entry_.begin(), first_entry_.end() - 1);
    for (std::size_t i = 0; i < chunks_.size(); ++i) {
        std::uint32_t entry = static_cast<std::uint32_t>(i) * patches_per_chunk;
        for (WarpPatch const& patch : chunks_[i].patches) {
            for_each_block(patch.box, columns_, [&](std::size_t block) { entries_[next_entry_[block]++] = entry; });
            ++entry;
        }
    }
}

void WarpPlan::block(std::size_t index, std::vector<PatchView>& patches) const {
    patches.clear();
    for (std::uint32_t i = first_entry_[index]; i < first_entry_[index + 1]; ++i) {
        Chunk const& chunk = chunks_[entries_[i] / patches_per_chunk];
        patches.push_back({&chunk.patches[entries_[i] % patches_per_chunk], chunk.splats.data()});
    }
    std::sort(patches.begin(), patches.end(), [](PatchView const& a, PatchView const& b) {
        return a.patch->batch != b.patch->batch ? a.patch->batch > b.patch->batch : a.patch->place < b.patch->place;
    });
}

} // namespace framelet
