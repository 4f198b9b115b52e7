// `frameless`: single pixels in random order, shown as soon as they arrive (Bishop et al. 1994; 004 section 2.5).
#include <algorithm>
#include <random>

#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/sample_message.h"

namespace framelet::bench {
namespace {

/// How long the server works before it sends what it has.
constexpr double step_seconds = 1.0 / 120;

class Frameless final : public Method {
public:
    explicit Frameless(MethodSetup const& setup) : setup_(setup), viewer_(setup.viewport) {
        auto const [width, height] = setup.viewport;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                order_.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), {}});
            }
        }
        // Every pixel once in each pass, in an order without coherence.
        std::mt19937_64 random(setup.seed);
        for (std::size_t i = order_.size(); i > 1; --i) {
            std::swap(order_[i - 1], order_[random() % i]);
        }
    }

    ServerStep produce(StepInput const& input) override {
        batch_.clear();
        for (std::size_t i = 0; i < batch_size_; ++i) {
            batch_.push_back(order_[next_]);
            next_ = (next_ + 1) % order_.size();
        }
        std::uint64_t const segments = render_pixels(input, setup_.viewport, batch_);
        ServerStep step;
        step.samples = batch_.size();
        double const samples = static_cast<double>(step.samples);
        step.seconds.render = 1e-9 * static_cast<double>(segments) * setup_.costs.incoherent_segment;
        step.seconds.encode = 1e-9 * samples * (setup_.costs.display_sample + setup_.costs.place_pixel);
        double const each = setup_.machine * step.seconds.server() / samples;
        batch_size_ = std::clamp<std::size_t>(static_cast<std::size_t>(step_seconds / each), 16, order_.size());
        step.message = encode_samples(input.time, batch_);
        return step;
    }

    ViewerStep consume(std::vector<std::byte> const& message) override {
        ViewerStep step;
        step.seconds.reconstruct = 1e-9 * static_cast<double>(viewer_.consume(message)) * setup_.costs.place_pixel;
        return step;
    }

    Picture const& picture() const override { return viewer_.picture(); }
    double mean_sample_time() const override { return viewer_.mean_sample_time(); }
    Window window() const override { return {16}; }

private:
    MethodSetup const setup_;
    std::vector<PixelSample> order_, batch_;
    std::size_t next_ = 0;
    std::size_t batch_size_ = 256;
    SampleViewer viewer_;
};

} // namespace

std::unique_ptr<Method> make_frameless(MethodSetup const& setup) {
    return std::make_unique<Frameless>(setup);
}

} // namespace framelet::bench
