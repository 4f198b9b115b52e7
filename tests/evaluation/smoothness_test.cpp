// Properties of `smoothness`' measures, and of the whole verb at a tiny size.
#include "tests/evaluation/smoothness.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/small_run.h"

namespace framelet::bench {
namespace {

/// Grey pictures of these values.
std::vector<Picture> greys(std::vector<int> const& values) {
    std::vector<Picture> pictures;
    for (int const value : values) {
        Picture picture(3, 2);
        for (std::size_t i = 0; i < picture.rgba.size(); ++i) {
            picture.rgba[i] = static_cast<std::uint8_t>(i % 4 == 3 ? 255 : value);
        }
        pictures.push_back(std::move(picture));
    }
    return pictures;
}

TEST(SecondDifference, IsNoneWhereAllGoesOnEvenly) {
    EXPECT_EQ(mean_squared_second_difference(greys({10, 30, 50, 70})), 0);
    EXPECT_EQ(mean_squared_second_difference(greys({10, 90, 20}), greys({5, 84, 13})), 0);
}

TEST(SecondDifference, AJumpCountsOnBothOfItsSides) {
    double const jump = 50.0 / 255;
    EXPECT_NEAR(mean_squared_second_difference(greys({0, 0, 50, 50})), jump * jump, 1e-12);
    EXPECT_NEAR(mean_squared_second_difference(greys({7, 7, 57}), greys({7, 7, 7})), jump * jump, 1e-12);
}

TEST(Smoothness, EveryLagIsToldOfAndTheViewersWorkWithIt) {
    SmoothnessStudy study;
    study.scenes = {source / "scenes/globe.glb"};
    study.lags_ms = {0, 100};
    StudyOptions options;
    options.run = small_run({48, 32}, 30);
    options.samples_per_side = 2;
    options.costs = usual_costs();
    auto const rows = measure_smoothness(study, options);
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0]["mse_now"], rows[0]["mse_as_shown"]) << "the two are one";
    EXPECT_LT(rows[1]["mse_as_shown"], rows[1]["mse_now"]);
    EXPECT_LT(rows[1]["second_difference_of_error"], rows[0]["second_difference_of_error"]);
    EXPECT_GT(rows[1]["viewer_seconds"], rows[0]["viewer_seconds"]);
}

} // namespace
} // namespace framelet::bench
