#include "tests/evaluation/methods/tsar_server.h"

#include <algorithm>
#include <cstring>

#include <tbb/parallel_for.h>

#include "common/color.h"
#include "common/error.h"
#include "protocol/messages/message_codec.h"
#include "server/render/display_framelet.h"
#include "server/render/framelet_renderer.h"
#include "tests/evaluation/methods/response/depth_first_order.h"

namespace framelet::bench {
namespace {

/// Framelets rendered in a cycle, by Table 7.1.
constexpr std::size_t default_batch = 128;
/// The least number of refreshes of a tile while `framed` shows one frame. [Stephens 2011] states bounds but not their
/// values.
constexpr double slowest_refresh = 1.0 / 8;
constexpr std::size_t most_blocks = framelet_samples;

/// Luma as displayed, 0 to 1, in Morton order.
std::array<float, framelet_samples> display_luma(DisplayFramelet const& framelet) {
    std::array<float, framelet_samples> luma;
    for (std::size_t i = 0; i < luma.size(); ++i) {
        luma[i] = (0.299f * framelet.red[i] + 0.587f * framelet.green[i] + 0.114f * framelet.blue[i]) / 255;
    }
    return luma;
}

/// The bounds of the densities that the renderer can realise: tiles of all depths; from every eighth frame of `framed`
/// to every cycle.
DensityBounds realisable(ImagePlane const& plane, double frames_per_second, std::size_t batch) {
    auto const samples = [&](int depth) { return std::exp2(2 * (depth - plane.pixel_depth())); };
    double const tiles = static_cast<double>(uniform_tile_count(plane, plane.pixel_depth()));
    double const cycles = std::max(2.0, tiles / static_cast<double>(batch));
    return {{samples(plane.min_depth()), slowest_refresh * frames_per_second},
            {samples(plane.max_depth()), cycles * frames_per_second}};
}

} // namespace

TsarServer::TsarServer(MethodSetup const& setup, TsarParameters const& parameters)
    : setup_(setup), parameters_(parameters), plane_(setup.viewport),
      // A batch is never more than a frame: [Stephens 2011] admits no batch that costs more (section 7.1.3).
      batch_framelets_(std::min(setup.batch_framelets > 0 ? setup.batch_framelets : default_batch,
                                uniform_tile_count(plane_, plane_.pixel_depth()))),
      response_{realisable(plane_, setup.frames_per_second, batch_framelets_), parameters.gain,
                // Both axes have one measure: the slowest rate counts as a sample per pixel. Were it the rate of
                // `framed`, nothing in a picture that stands still would ask for more, and no density would be moved.
                slowest_refresh * setup.frames_per_second, -setup.bias},
      // Elements are as small as the finest tile: 128x128 at 512x512 pixels, Table 7.1.
      density_(make_uniform_density(plane_.max_depth(), {1, setup.frames_per_second})),
      refreshed_(density_.size(), -1.0) {
    // The budget is what `framed` spends: one sample a pixel and frame. Outside the viewport there are no samples.
    for (std::uint32_t i = 0; i < density_.size(); ++i) {
        if (!plane_.is_visible(make_tile(density_.depth, morton_x(i), morton_y(i)))) {
            density_.space[i] = 0;
        }
    }
    build_tiling();
}

void TsarServer::build_tiling() {
    tiling_ = make_density_tiling(plane_, density_.space, density_.depth, parameters_.most_samples);
}

ServerStep TsarServer::produce(StepInput const& input) {
    clock_ += std::max(0.0, input.time - last_input_);
    last_input_ = input.time;
    ServerStep step;
    auto const chosen = select_overdue(tiling_.tiles, density_, refreshed_, clock_, batch_framelets_);
    std::vector<Tile> tiles;
    for (std::size_t const i : chosen) {
        tiles.push_back(tiling_.tiles[i]);
    }
    field_from_tiles(tiles, std::vector<double>(tiles.size(), clock_), refreshed_);

    std::vector<Framelet> rendered(tiles.size());
    std::uint64_t const segments =
        render_framelets(*input.scene.render_scene, input.view.camera, plane_, tiles, rendered);
    ++batch_.number;
    batch_.view = input.view;
    batch_.scene_time = input.time;
    batch_.framelets.resize(rendered.size());
    tbb::parallel_for(std::size_t(0), rendered.size(),
                      [&](std::size_t i) { batch_.framelets[i] = to_display(rendered[i], input.scene.exposure); });
    auto const encoded = encode_message(codec_.encode(batch_));
    step.message.resize(sizeof(clock_));
    std::memcpy(step.message.data(), &clock_, sizeof(clock_));
    step.message.insert(step.message.end(), encoded.begin(), encoded.end());

    std::size_t const selected_from = tiling_.tiles.size();
    estimate(batch_);
    respond(density_, elements_, errors_, response_, scratch_);
    build_tiling();
    forget_old_records();

    CostTable const& costs = setup_.costs;
    step.samples = tiles.size() * framelet_samples;
    double const samples = static_cast<double>(step.samples);
    step.seconds.render = 1e-9 * static_cast<double>(segments) * costs.coherent_segment;
    step.seconds.response =
        1e-9 * (static_cast<double>(selected_from) * costs.tiling_element + samples * costs.estimate_sample +
                static_cast<double>(elements_.size()) * costs.respond_element +
                static_cast<double>(density_.size()) * costs.tiling_element);
    step.seconds.encode = 1e-9 * samples * (costs.display_sample + costs.encode_sample);
    clock_ += setup_.machine * step.seconds.server();
    last_input_ = std::max(last_input_, input.time + setup_.machine * step.seconds.server());
    return step;
}

void TsarServer::estimate(Batch const& batch) {
    elements_.clear();
    errors_.clear();
    std::array<RateError, most_blocks> blocks;
    for (DisplayFramelet const& framelet : batch.framelets) {
        TileRecord& record = records_[framelet.tile.code];
        int const levels = 2 * (density_.depth - framelet.tile.depth());
        std::size_t const count = std::size_t(1) << levels;
        std::size_t const block_count = std::min(count, most_blocks);
        auto const luma = display_luma(framelet);
        estimate_haar(luma, record.history, static_cast<float>(clock_ - record.time), parameters_.templates,
                      std::span(blocks).first(block_count));
        record.time = clock_;
        std::size_t const first = std::size_t(framelet.tile.index()) << levels;
        for (std::size_t i = 0; i < count; ++i) {
            if (density_.space[first + i] > 0) {
                elements_.push_back(static_cast<std::uint32_t>(first + i));
                errors_.push_back(blocks[i * block_count / count]);
            }
        }
    }
}

void TsarServer::forget_old_records() {
    // Coefficients are worth keeping for as long as a framelet may be the newest of its tile.
    if (records_.size() > 4 * tiling_.tiles.size()) {
        double const oldest = clock_ - 1 / response_.bounds.least.time;
        std::erase_if(records_, [oldest](auto const& record) { return record.second.time < oldest; });
    }
}

TsarMessage decode_tsar_message(std::vector<std::byte> const& message) {
    TsarMessage out;
    FRAMELET_CHECK(message.size() >= sizeof(out.time));
    std::memcpy(&out.time, message.data(), sizeof(out.time));
    out.batch = std::get<EncodedBatch>(decode_message(std::span(message).subspan(sizeof(out.time))));
    return out;
}

} // namespace framelet::bench
