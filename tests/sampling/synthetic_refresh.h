// Drives AdaptiveRefresh without a scene: a picture that is a function of region and time, on a virtual clock that goes
// on by what rendering would take. In: the function, rates. Out: what was planned, rendered and sent.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "common/color.h"
#include "server/sampling/plan/adaptive_refresh.h"
#include "server/stream/layers/layer_fit.h"

namespace framelet {

/// Display-encoded grey, [0, 1], of a point in pixel coordinates at a scene time.
using Shading = std::function<float(float x, float y, double time)>;

/// Smooth noise in [0, 1]; its features are about 1 wide.
inline float smooth_noise(float x, float y) {
    auto const corner = [](float column, float row) {
        auto hash = static_cast<std::uint32_t>(static_cast<std::int32_t>(column)) * 0x9e3779b1u +
                    static_cast<std::uint32_t>(static_cast<std::int32_t>(row)) * 0x85ebca77u;
        hash = (hash ^ (hash >> 15)) * 0x2c1b3c6du;
        hash = (hash ^ (hash >> 12)) * 0x297a2d39u;
        return static_cast<float>((hash ^ (hash >> 15)) & 0xffff) / 65535.0f;
    };
    float const column = std::floor(x);
    float const row = std::floor(y);
    float const u = (x - column) * (x - column) * (3 - 2 * (x - column));
    float const v = (y - row) * (y - row) * (3 - 2 * (y - row));
    float const above = corner(column, row) * (1 - u) + corner(column + 1, row) * u;
    float const below = corner(column, row + 1) * (1 - u) + corner(column + 1, row + 1) * u;
    return above * (1 - v) + below * v;
}

class SyntheticRefresh {
public:
    SyntheticRefresh(Viewport viewport, Shading shading) : shading_(std::move(shading)) {
        input.state.view.viewport = viewport;
        input.samples_per_second = std::max(4.0 * viewport.width * viewport.height, 1e5);
        input.motions = &motions_;
        input.moves_samples = false;
    }

    /// Plans and renders a batch, which takes its time; learns and sends it, or the one before where it is pipelined.
    /// False when there was nothing to do: a cycle passes.
    bool step() {
        input.state.scene_time = running ? input.now : stopped_at;
        if (running && camera_speed > 0) {
            input.state.view.camera.position.x = camera_speed * static_cast<float>(input.now);
        }
        if (!running) {
            input.moment.reset();
        } else if (!input.moment || input.now >= input.moment->begun + moment_length) {
            input.moment = HeldMoment{input.state, input.now};
        }
        RefreshPlan plan;
        refresh.plan(input, plan);
        tiles = plan.tiles;
        patches = plan.patches;
        rays_per_sample = plan.rays_per_sample;
        probes = plan.probes.size();
        sent.clear();
        bool const learns = !rendered_plan_.is_empty();
        if (learns) {
            learn();
        }
        if (plan.is_empty()) {
            input.now += learns ? 0 : static_cast<double>(input.cycle_seconds);
            return learns;
        }
        render(plan);
        rendered_plan_ = std::move(plan);
        double const cost = static_cast<double>(rendered_plan_.ray_count() + 2 * probes);
        input.now += cost / input.samples_per_second;
        if (!pipelined) {
            learn();
        }
        return true;
    }

    /// Goes on for so many seconds; `each` is called after every batch.
    template <class Each>
    void run(double seconds, Each&& each) {
        double const end = input.now + seconds;
        while (input.now < end) {
            step();
            each();
        }
    }
    void run(double seconds) {
        run(seconds, [] {});
    }
    void stop() {
        running = false;
        stopped_at = input.now;
    }
    /// Steps until there is nothing to do or so many seconds have passed; returns the seconds.
    double finish(double most_seconds) {
        double const begin = input.now;
        while (input.now < begin + most_seconds) {
            double const now = input.now;
            if (!step()) {
                return now - begin;
            }
        }
        return std::numeric_limits<double>::infinity();
    }

    RefreshInput input;
    bool pipelined = true; ///< a batch is learnt once the next one has been planned, as in the server
    bool running = true; ///< the scene clock
    double stopped_at = 0; ///< scene time while it is not
    float camera_speed = 0; ///< metres a second, while the clock runs; what is to be seen is the same everywhere
    /// Mean squared error that so many paths a sample leave of a tile; empty: there are no paths.
    std::function<float(Tile, int)> error_of_paths;
    double moment_length = 0.05; ///< seconds for which moments are held while the clock runs
    AdaptiveRefresh refresh;

    // What the last step planned and sent:
    std::vector<Tile> tiles;
    std::vector<Patch> patches;
    int rays_per_sample = single_ray;
    std::size_t probes = 0;
    std::vector<DisplayFramelet> sent;

private:
    void learn() {
        shapes_.clear();
        std::vector<float> errors;
        if (error_of_paths) {
            for (Tile const tile : rendered_plan_.tiles) {
                errors.push_back(error_of_paths(tile, rendered_plan_.rays_per_sample));
            }
        }
        auto const& send = refresh.learn(rendered_plan_, display_, rendered_, {luma_}, errors);
        for (std::size_t i = 0; i < display_.size(); ++i) {
            if (send[i] != 0) {
                sent.push_back(display_[i]);
                fit_layers(rendered_[i], ImagePlane(rendered_plan_.viewport), {1e-5f}, shapes_.emplace_back());
            }
        }
        refresh.note_sent(rendered_plan_, ++batch_, display_, rendered_, send, shapes_);
        rendered_plan_ = {};
    }
    std::uint8_t shade(float x, float y) const {
        SceneTime const time = input.moment ? input.moment->state.scene_time : input.state.scene_time;
        return static_cast<std::uint8_t>(std::lround(255 * shading_(x, y, time)));
    }
    /// Shades a cell of this side: in its middle, or the mean of its quarters.
    std::uint8_t shade_cell(float x, float y, float side, int rays) const {
        if (rays == single_ray) {
            return shade(x, y);
        }
        float const step = 0.25f * side;
        float sum = 0;
        for (auto const& [dx, dy] : {std::pair{-step, -step}, {step, -step}, {-step, step}, {step, step}}) {
            sum += linear_from_srgb_byte(shade(x + dx, y + dy));
        }
        return srgb_byte_from_linear(sum / four_rays);
    }
    void render(RefreshPlan const& plan) {
        ImagePlane const plane(input.state.view.viewport);
        display_.resize(plan.tiles.size());
        rendered_.resize(plan.tiles.size());
        for (std::size_t t = 0; t < plan.tiles.size(); ++t) {
            DisplayFramelet& framelet = display_[t];
            framelet.tile = rendered_[t].tile = plan.tiles[t];
            PixelRect const rect = plane.tile_rect(framelet.tile);
            float const spacing = plane.sample_spacing(framelet.tile);
            for (std::uint32_t i = 0; i < framelet_samples; ++i) {
                framelet.red[i] =
                    shade_cell(static_cast<float>(rect.left) + (static_cast<float>(morton_x(i)) + 0.5f) * spacing,
                               static_cast<float>(rect.top) + (static_cast<float>(morton_y(i)) + 0.5f) * spacing,
                               spacing, error_of_paths ? single_ray : plan.rays_per_sample);
            }
            framelet.green = framelet.blue = framelet.red;
            rendered_[t].depth.fill(10);
            rendered_[t].is_supersampled = plan.rays_per_sample != single_ray;
        }
        luma_.clear();
        for (Probe const& probe : plan.probes) {
            std::uint8_t const grey = shade(probe.position.x, probe.position.y);
            luma_.push_back(display_luma(grey, grey, grey));
        }
    }

    Shading shading_;
    BodyMotions motions_;
    RefreshPlan rendered_plan_; ///< what was rendered and is not learnt yet
    std::vector<FrameletShape> shapes_; ///< of what is sent
    std::uint64_t batch_ = 0;
    std::vector<DisplayFramelet> display_;
    std::vector<Framelet> rendered_;
    std::vector<float> luma_;
};

} // namespace framelet
