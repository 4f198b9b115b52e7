#include "tests/evaluation/methods/sample_message.h"

#include <cstring>
#include <numeric>

#include "common/color.h"
#include "common/error.h"

namespace framelet::bench {
namespace {

constexpr std::size_t sample_bytes = 7;

} // namespace

std::uint64_t render_pixels(StepInput const& input, Viewport viewport, std::span<PixelSample> places) {
    std::vector<Vec2> centres(places.size());
    for (std::size_t i = 0; i < places.size(); ++i) {
        centres[i] = Vec2(places[i].x, places[i].y) + 0.5f;
    }
    std::vector<Vec3> radiance(places.size());
    ViewRays const rays = make_view_rays(input.view.camera, viewport);
    std::uint64_t const segments = render_samples(*input.scene.render_scene, rays, centres, 1, radiance);
    for (std::size_t i = 0; i < places.size(); ++i) {
        Vec3 const shown = tone_map(radiance[i] * input.scene.exposure);
        places[i].rgb = {srgb_byte_from_linear(shown.r), srgb_byte_from_linear(shown.g),
                         srgb_byte_from_linear(shown.b)};
    }
    return segments;
}

std::vector<std::byte> encode_samples(SceneTime time, std::span<PixelSample const> samples) {
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

SampleViewer::SampleViewer(Viewport viewport)
    : picture_(viewport.width, viewport.height), times_(picture_.rgba.size() / 4) {
    for (std::size_t i = 3; i < picture_.rgba.size(); i += 4) {
        picture_.rgba[i] = 255;
    }
}

std::size_t SampleViewer::consume(std::vector<std::byte> const& message) {
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
    return count;
}

double SampleViewer::mean_sample_time() const {
    return std::accumulate(times_.begin(), times_.end(), 0.0) / static_cast<double>(times_.size());
}

} // namespace framelet::bench
