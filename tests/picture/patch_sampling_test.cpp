#include "common/warp/patch_sampling.h"

#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace framelet {
namespace {

struct Expected {
    double weight = 0, red = 0, green = 0, blue = 0;
};

/// The expected sums: tents of radius one sample over the samples that lie on the layer.
Expected expect(WarpPatch const& patch, double x, double y) {
    auto const at = [&](std::size_t i) { return patch.at[i] + x * patch.dx[i] + y * patch.dy[i]; };
    double const u = at(0) / at(2);
    double const v = at(1) / at(2);
    Expected out;
    for (int j = 0; j < patch.side; ++j) {
        for (int i = 0; i < patch.side; ++i) {
            PackedSample const sample = patch.grid[j * patch.stride + i];
            double const weight = std::max(1 - std::abs(u - i), 0.0) * std::max(1 - std::abs(v - j), 0.0);
            if (at(2) > 0 && layer_of(sample) == patch.layer) {
                out.weight += weight;
                out.red += weight * square(red_of(sample));
                out.green += weight * square(green_of(sample));
                out.blue += weight * square(blue_of(sample));
            }
        }
    }
    return out;
}

/// Samples grids of all sizes, parts of larger ones too, nearly upright and tilted, fine and coarse, partly behind the
/// camera.
TEST(PatchSampling, IsBilinearInterpolationWhereverSamplesLie) {
    std::mt19937 random(8);
    auto const uniform = [&](float low, float high) {
        return std::uniform_real_distribution<float>(low, high)(random);
    };
    constexpr int largest = 32;
    CandidateColumn column;
    for (int trial = 0; trial < 4000; ++trial) {
        WarpPatch patch;
        patch.side = 4 << trial % 4;
        patch.stride = trial % 8 < 4 ? patch.side : largest;
        patch.layer = trial % 2 == 0 ? 1 : 201;
        // The grid is no longer than it must be, so that the sanitizer finds what is read beyond it.
        std::vector<PackedSample> grid(static_cast<std::size_t>(patch.stride * (patch.side - 1) + patch.side));
        for (PackedSample& sample : grid) {
            PackedSample const layer =
                trial % 4 < 2 || random() % 2 == 0 ? patch.layer : patch.layer ^ 1u << random() % 8;
            sample = static_cast<PackedSample>(random() & 0xffffffu) | layer << 24;
        }
        patch.grid = grid.data();
        auto const n = static_cast<float>(patch.side);
        float const scale = std::exp(uniform(-1.5f, 1));
        float const angle = trial % 3 == 0 ? uniform(-3.2f, 3.2f) : uniform(-0.05f, 0.05f);
        patch.dx = {scale * std::cos(angle), scale * std::sin(angle), uniform(-0.01f, 0.01f)};
        patch.dy = {-scale * std::sin(angle), scale * std::cos(angle), uniform(-0.01f, 0.01f)};
        patch.at = {uniform(-2, 2 + n), uniform(-2, 2 + n), uniform(0.1f, 1.2f)};
        patch.box = {0, 0, 3 + static_cast<int>(random() % 16), 3 + static_cast<int>(random() % 14)};
        float const x = static_cast<float>(static_cast<int>(random() % 12) - 4);
        float const y = -static_cast<float>(trial % wide_rows); // the first row of some is above the box
        int const count = (patch.box.height() - static_cast<int>(y) + wide_rows - 1) / wide_rows;
        if (count > static_cast<int>(column.size())) {
            continue;
        }
        sample_patch(patch, x, y, count, column);
        for (int i = 0; i < count; ++i) {
            Candidate const& found = column[static_cast<std::size_t>(i)];
            for (int k = 0; k < wide_count; ++k) {
                double const px = x + static_cast<float>(wide_column[k]);
                double const row = y + static_cast<float>(i * wide_rows + wide_row[k]);
                bool const in_box = px >= 0 && px < patch.box.width() && row >= 0 && row < patch.box.height();
                Expected const expected = in_box ? expect(patch, px, row) : Expected{};
                double const z = patch.at[2] + px * patch.dx[2] + row * patch.dy[2];
                if (std::abs(z) < 0.05) {
                    continue; // near the horizon of the plane rounding shows
                }
                double const rounding = 1e-4 / (z * z); // in samples
                ASSERT_NEAR(found.weight[k], expected.weight, rounding) << trial << ' ' << row << ' ' << k;
                ASSERT_NEAR(found.red[k], expected.red, 65025 * rounding) << trial << ' ' << row << ' ' << k;
                ASSERT_NEAR(found.green[k], expected.green, 65025 * rounding) << trial << ' ' << row << ' ' << k;
                ASSERT_NEAR(found.blue[k], expected.blue, 65025 * rounding) << trial << ' ' << row << ' ' << k;
            }
        }
    }
}

} // namespace
} // namespace framelet
