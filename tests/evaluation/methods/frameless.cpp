// The method `frameless`: single pixels in random order, shown as soon as they arrive ([Bishop 1994];
// [Stephens 2011] section 2.5).
#include <random>

#include "tests/evaluation/methods/methods.h"
#include "tests/evaluation/methods/single_pixels.h"

namespace framelet::bench {
namespace {

class Frameless final : public SinglePixels {
public:
    explicit Frameless(MethodSetup const& setup) : SinglePixels(setup) {
        auto const [width, height] = setup.viewport;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                order_.push_back({static_cast<std::uint16_t>(x), static_cast<std::uint16_t>(y), {}});
            }
        }
        // The order has every pixel once in each pass, and no coherence.
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
        return send_batch(input, 0);
    }

private:
    std::vector<PixelSample> order_;
    std::size_t next_ = 0;
};

} // namespace

std::unique_ptr<Method> make_frameless(MethodSetup const& setup) {
    return std::make_unique<Frameless>(setup);
}

} // namespace framelet::bench
