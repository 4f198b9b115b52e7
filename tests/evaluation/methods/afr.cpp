// `afr`: adaptive frameless rendering (Dayal et al. 2005; 004 section 2.5): single pixels, each in a leaf chosen with
// equal probability; leaves are small where the picture's error is great.
#include <algorithm>
#include <random>

#include "tests/evaluation/methods/kd_leaves.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/sample_message.h"

namespace framelet::bench {
namespace {

/// How long the server works before it sends what it has and adapts its leaves.
constexpr double step_seconds = 1.0 / 120;
constexpr int pixels_a_leaf = 64;
/// Share of the leaves that a step splits, and merges.
constexpr double adapted_share = 1.0 / 64;

class AdaptiveFrameless final : public Method {
public:
    explicit AdaptiveFrameless(MethodSetup const& setup)
        : setup_(setup), leaves_(setup.viewport, pixels_a_leaf), random_(setup.seed), viewer_(setup.viewport),
          pixels_(static_cast<std::size_t>(setup.viewport.width) * static_cast<std::size_t>(setup.viewport.height)) {}

    ServerStep produce(StepInput const& input) override {
        batch_.clear();
        chosen_.clear();
        for (std::size_t i = 0; i < batch_size_; ++i) {
            if (seen_ < pixels_) { // every pixel once first, or the picture would have holes
                std::size_t const x = seen_ % static_cast<std::size_t>(setup_.viewport.width);
                std::size_t const y = seen_ / static_cast<std::size_t>(setup_.viewport.width);
                ++seen_;
                batch_.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), {}});
                continue;
            }
            std::size_t const leaf = random_() % leaves_.size();
            PixelRect const& rect = leaves_.rect(leaf);
            auto const pick = [&](int from, int to) {
                return static_cast<std::uint16_t>(from + static_cast<int>(random_() % std::uint64_t(to - from)));
            };
            std::uint16_t const x = pick(rect.left, rect.right);
            std::uint16_t const y = pick(rect.top, rect.bottom);
            chosen_.push_back(leaf);
            batch_.push_back({x, y, {}});
        }
        std::uint64_t const segments = render_pixels(input, setup_.viewport, batch_);
        std::size_t const first_chosen = batch_.size() - chosen_.size();
        for (std::size_t i = 0; i < chosen_.size(); ++i) {
            auto const& [red, green, blue] = batch_[first_chosen + i].rgb;
            float const luma = (0.299f * red + 0.587f * green + 0.114f * blue) / 255;
            leaves_.add(chosen_[i], input.time, luma);
        }
        if (!chosen_.empty()) {
            leaves_.adapt(static_cast<std::size_t>(adapted_share * static_cast<double>(leaves_.size())));
        }

        ServerStep step;
        step.samples = batch_.size();
        double const samples = static_cast<double>(step.samples);
        step.seconds.render = 1e-9 * static_cast<double>(segments) * setup_.costs.incoherent_segment;
        step.seconds.response = 1e-9 * samples * setup_.costs.afr_sample;
        step.seconds.encode = 1e-9 * samples * (setup_.costs.display_sample + setup_.costs.place_pixel);
        double const each = setup_.machine * step.seconds.server() / samples;
        batch_size_ = std::clamp<std::size_t>(static_cast<std::size_t>(step_seconds / each), 16, pixels_);
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
    KdLeaves leaves_;
    std::mt19937_64 random_;
    std::vector<PixelSample> batch_;
    std::vector<std::size_t> chosen_; ///< leaf of each of the batch's last samples
    std::size_t batch_size_ = 256;
    SampleViewer viewer_;
    std::size_t const pixels_;
    std::size_t seen_ = 0; ///< pixels of the first pass
};

} // namespace

std::unique_ptr<Method> make_afr(MethodSetup const& setup) {
    return std::make_unique<AdaptiveFrameless>(setup);
}

} // namespace framelet::bench
