#include "server/session/loop/cycle_recorder.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/error.h"
#include "common/files/image_io.h"

namespace framelet {
namespace {

class CycleRecorderTest : public testing::Test {
protected:
    std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("framelet-recorder-" + std::to_string(getpid()));

    void TearDown() override { std::filesystem::remove_all(folder); }

    std::vector<nlohmann::json> lines() const {
        std::ifstream stream(folder / "cycles.jsonl");
        std::vector<nlohmann::json> all;
        for (std::string line; std::getline(stream, line);) {
            all.push_back(nlohmann::json::parse(line));
        }
        return all;
    }
};

/// A refresh that has planned its first cycle and rendered nothing.
AdaptiveRefresh planned() {
    AdaptiveRefresh refresh;
    RefreshInput input;
    input.state.view.viewport = {320, 200};
    input.now = 1;
    input.samples_per_second = 1e6;
    RefreshPlan plan;
    refresh.plan(input, plan);
    return refresh;
}

TEST_F(CycleRecorderTest, ALineForEachBatchAndPicturesAtTheirRate) {
    {
        CycleRecorder recorder(folder / "made", 2);
        AdaptiveRefresh const refresh = planned();
        for (int i = 0; i < 5; ++i) {
            CycleRecord record;
            record.session = 7;
            record.samples_rendered = 256;
            describe(refresh, record);
            recorder.add(record, refresh, 10 + 0.02 * i);
        }
    }
    folder /= "made";
    auto const all = lines();
    ASSERT_EQ(all.size(), 5u);
    EXPECT_EQ(all[0]["session"], 7);
    EXPECT_EQ(all[0]["cycle"], 1);
    EXPECT_EQ(all[0]["samples_rendered"], 256);
    EXPECT_NEAR(all[0]["budget"].get<double>(), 1e6 * static_cast<double>(RefreshInput().cycle_seconds), 1);
    EXPECT_GT(all[0]["mean_shown_error"].get<double>(), 0);
    EXPECT_LT(all[0]["mean_shown_error"].get<double>(), static_cast<double>(bare_error)) << "what is taken counts";
    EXPECT_GT(all[0]["regions_by_level"][0], 0) << "everything is bare";
    EXPECT_NEAR(all[4]["seconds"].get<double>(), 0.08, 1e-9);
    for (char const* const view : {"tiles", "density", "error", "motion"}) {
        Picture const picture = read_picture(folder / ("7-000001-" + std::string(view) + ".png"));
        EXPECT_EQ(picture.width, 320);
        EXPECT_EQ(picture.height, 200);
    }
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 5) << "one set in half a second";
    folder = folder.parent_path();
}

TEST_F(CycleRecorderTest, APlanWithoutChoicesHasNoPictures) {
    BodyMotions const motions;
    AdaptiveRefresh refresh;
    {
        CycleRecorder recorder(folder, 2);
        CycleRecord record;
        recorder.add(record, refresh, 10);
        RefreshInput input;
        input.state.view.viewport = {320, 200};
        input.now = 1;
        input.samples_per_second = 1e6;
        input.motions = &motions;
        input.moment = HeldMoment{input.state, 0.5};
        RefreshPlan plan;
        refresh.plan(input, plan);
        recorder.add(record, refresh, 11);
    }
    EXPECT_EQ(lines().size(), 2u);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder), {}), 1);
}

TEST_F(CycleRecorderTest, RefusesAFolderThatCannotBe) {
    std::ofstream(folder) << "a file";
    EXPECT_THROW(CycleRecorder(folder, 4), InputError);
    EXPECT_THROW(CycleRecorder(folder / "below", 4), InputError);
}

} // namespace
} // namespace framelet
