#include "tests/evaluation/methods/single_pixels.h"

#include <algorithm>
#include <cstring>
#include <numeric>

#include "common/color.h"
#include "common/error.h"

namespace framelet::bench {
namespace {

/// Seconds that the server works before it sends what it has.
constexpr double step_seconds = 1.0 / 120;
/// Bytes of a sample in a message: random places and their colours hardly compress.
constexpr std::size_t sample_bytes = 7;

/// Renders the samples' pixels. Returns the number of rays traced.
std::uint64_t render_pixels(StepInput const& input, Viewport viewport, std::vector<PixelSample>& samples) {
    std::vector<Vec2> centres(samples.size());
    std::ranges::transform(samples, centres.begin(),
                           [](PixelSample const& sample) { return Vec2(sample.x, sample.y) + 0.5f; });
    std::vector<float> const spacings(samples.size(), 1.0f);
    std::vector<Vec3> radiance(samples.size());
    ViewRays const rays = make_view_rays(input.view.camera, viewport);
    std::uint64_t const segments = render_samples(*input.scene.render_scene, rays, centres, spacings, radiance);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        Vec3 const shown = tone_map(radiance[i] * input.scene.exposure);
        samples[i].rgb = {srgb_byte_from_linear(shown.r), srgb_byte_from_linear(shown.g),
                          srgb_byte_from_linear(shown.b)};
    }
    return segments;
}

/// A message: scene time, then the samples.
std::vector<std::byte> encode_samples(SceneTime time, std::vector<PixelSample> const& samples) {
    std::vector<std::byte> message(sizeof(time) + samples.size() * sample_bytes);
    std::memcpy(message.data(), &time, sizeof(time));
    std::byte* out = message.data() + sizeof(time);
    for (PixelSample const& sample : samples) {
        std::memcpy(out, &sample.x, 2);
        std::memcpy(out + 2, &sample.y, 2);
        std::memcpy(out + 4, sample.rgb.data(), 3);
        out += sample_bytes;
    }
    return message;
}

} // namespace

SinglePixels::SinglePixels(MethodSetup const& setup)
    : setup_(setup), picture_(setup.viewport.width, setup.viewport.height), times_(picture_.rgba.size() / 4) {
    for (std::size_t i = 3; i < picture_.rgba.size(); i += 4) {
        picture_.rgba[i] = 255;
    }
}

ServerStep SinglePixels::send_batch(StepInput const& input, double response_ns) {
    CostTable const& costs = setup_.costs;
    std::uint64_t const segments = render_pixels(input, setup_.viewport, batch_);
    ServerStep step;
    step.samples = batch_.size();
    double const samples = static_cast<double>(step.samples);
    step.seconds.render = 1e-9 * static_cast<double>(segments) * costs.incoherent_segment;
    step.seconds.response = 1e-9 * samples * response_ns;
    step.seconds.encode = 1e-9 * samples * (costs.display_sample + costs.place_pixel);
    double const each = setup_.machine * step.seconds.server() / samples;
    batch_size_ = std::clamp<std::size_t>(static_cast<std::size_t>(step_seconds / each), 16, pixel_count());
    step.message = encode_samples(input.time, batch_);
    return step;
}

ViewerStep SinglePixels::consume(std::vector<std::byte> const& message) {
    SceneTime time = 0;
    FRAMELET_CHECK(message.size() >= sizeof(time));
    std::memcpy(&time, message.data(), sizeof(time));
    std::size_t const count = (message.size() - sizeof(time)) / sample_bytes;
    std::byte const* in = message.data() + sizeof(time);
    for (std::size_t i = 0; i < count; ++i, in += sample_bytes) {
        std::uint16_t x = 0, y = 0;
        std::memcpy(&x, in, 2);
        std::memcpy(&y, in + 2, 2);
        FRAMELET_CHECK(x < picture_.width && y < picture_.height);
        std::memcpy(picture_.row(y) + std::size_t(x) * 4, in + 4, 3);
        times_[std::size_t(y) * static_cast<std::size_t>(picture_.width) + x] = time;
    }
    ViewerStep step;
    step.seconds.reconstruct = 1e-9 * static_cast<double>(count) * setup_.costs.place_pixel;
    return step;
}

double SinglePixels::mean_sample_time() const {
    return std::accumulate(times_.begin(), times_.end(), 0.0) / static_cast<double>(times_.size());
}

} // namespace framelet::bench
