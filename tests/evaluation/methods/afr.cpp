// The method `afr`: adaptive frameless rendering ([Dayal 2005]; [Stephens 2011] section 2.5): single pixels, each
// in a leaf chosen with equal probability; leaves are small where the picture's error is great.
#include <random>

#include "tests/evaluation/methods/kd_leaves.h"
#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/single_pixels.h"

namespace framelet::bench {
namespace {

constexpr int pixels_a_leaf = 64;
/// Share of the leaves that a step splits, and merges.
constexpr double adapted_share = 1.0 / 64;

class AdaptiveFrameless final : public SinglePixels {
public:
    explicit AdaptiveFrameless(MethodSetup const& setup)
        : SinglePixels(setup), leaves_(setup.viewport, pixels_a_leaf), random_(setup.seed) {}

    ServerStep produce(StepInput const& input) override {
        batch_.clear();
        chosen_.clear();
        for (std::size_t i = 0; i < batch_size_; ++i) {
            if (seen_ < pixel_count()) { // the first pass takes every pixel once, or the picture would have holes
                std::size_t const width = static_cast<std::size_t>(setup_.viewport.width);
                batch_.push_back(
                    {static_cast<std::uint16_t>(seen_ % width), static_cast<std::uint16_t>(seen_ / width), {}});
                ++seen_;
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
        ServerStep step = send_batch(input, setup_.costs.afr_sample);
        std::size_t const first_chosen = batch_.size() - chosen_.size();
        for (std::size_t i = 0; i < chosen_.size(); ++i) {
            auto const& [red, green, blue] = batch_[first_chosen + i].rgb;
            float const luma = (0.299f * red + 0.587f * green + 0.114f * blue) / 255;
            leaves_.add(chosen_[i], input.time, luma);
        }
        if (!chosen_.empty()) {
            leaves_.adapt(static_cast<std::size_t>(adapted_share * static_cast<double>(leaves_.size())));
        }
        return step;
    }

private:
    KdLeaves leaves_;
    std::mt19937_64 random_;
    std::vector<std::size_t> chosen_; ///< leaf of each of the batch's last samples
    std::size_t seen_ = 0; ///< pixels that the first pass has taken so far
};

} // namespace

std::unique_ptr<Method> make_afr(MethodSetup const& setup) {
    return std::make_unique<AdaptiveFrameless>(setup);
}

} // namespace framelet::bench
