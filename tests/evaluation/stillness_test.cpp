// Tests properties of `stillness`' measures, and the whole verb at a tiny size. Nothing here is about speed.
#include "tests/evaluation/stillness.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/evaluation/small_run.h"

namespace framelet::bench {
namespace {

TEST(PsnrOverTime, IsThatOfTheLastMeasurement) {
    PsnrOverTime const quality{{0.1, 0.2, 0.3}, {30, 35, 40}};
    EXPECT_EQ(quality.at(0), 30) << "nothing is known of before";
    EXPECT_EQ(quality.at(0.2), 35);
    EXPECT_EQ(quality.at(0.29), 35);
    EXPECT_EQ(quality.at(9), 40);
}

TEST(PsnrOverTime, AFallIsFromTheBestBefore) {
    EXPECT_EQ((PsnrOverTime{{0, 1, 2}, {30, 35, 40}}.most_fall()), 0);
    EXPECT_EQ((PsnrOverTime{{0, 1, 2, 3, 4}, {30, 38, 36, 35, 50}}.most_fall()), 3);
}

using Stillness = SmallRuns;

TEST_F(Stillness, ThePictureBecomesTheReferenceAndNothingMoreIsSent) {
    StudyOptions options = study(small_run({48, 32}, 10));
    options.scenes = {bundled("globe"), bundled("stop")};
    options.run.frames_per_second = 30;
    options.run.seconds = 8;
    auto const rows = measure_stillness(options);
    ASSERT_EQ(rows.size(), 2u);
    for (auto const& row : rows) {
        EXPECT_GE(row["final_psnr"], 40) << row["scene"];
        // The picture falls a little where moved means of four rays give way to single rays in their places, which
        // alias more.
        EXPECT_LE(row["most_fall_db"], 1) << row["scene"];
        EXPECT_GT(row["bytes"], 0);
        EXPECT_LT(row["last_sent_seconds"], options.run.seconds - 1);
        EXPECT_EQ(row["last_second_bytes"], 0);
    }
}

} // namespace
} // namespace framelet::bench
