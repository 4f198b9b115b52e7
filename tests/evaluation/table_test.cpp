// Tests the published table, and runs of it: small pictures, little time.
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "protocol/messages/message.h"
#include "protocol/messages/message_codec.h"
#include "tests/evaluation/small_run.h"
#include "tests/evaluation/table.h"

namespace framelet::bench {
namespace {

TEST(PublishedTable, IsTheDissertations) {
    PublishedTable const& table = published_table();
    ASSERT_EQ(table.scenes.size(), 5u);
    ASSERT_EQ(table.runs.size(), 16u);
    EXPECT_EQ(table.scenes.front(), "vehicle_fixed");
    double sum = 0;
    for (std::size_t i = 0; i < table.runs.size(); ++i) {
        EXPECT_EQ(table.runs[i].number, static_cast<int>(i));
        for (double const per_cent : table.runs[i].suitable) {
            sum += per_cent;
        }
    }
    EXPECT_EQ(sum, 5483);
    EXPECT_EQ(table.runs[11].batch, 512);
    EXPECT_EQ(table.runs[11].side, 512);
    EXPECT_EQ(table.runs[11].suitable, (std::vector<double>{80, 100, 100, 52, 91}));
}

using Table = SmallRuns;

TEST_F(Table, BatchesHaveNoMoreFrameletsThanTheRunSays) {
    auto const scene = load_bench_scene(bundled("vehicle_chase"));
    auto const largest = [&](std::size_t batch_framelets) {
        auto const method = make_method(
            "framelet", {.viewport = {128, 128}, .costs = costs, .machine = 0.1, .batch_framelets = batch_framelets});
        std::size_t most = 0;
        for (int step = 0; step < 6; ++step) {
            pose_at(*scene, 0.1 * step);
            auto const message =
                method->produce({*scene, 0.1 * step, 0.1 * step, {1, scene->camera, {128, 128}}, 0, {}}).message;
            if (message.empty()) { // the step's framelets are sent with the next one
                continue;
            }
            most = std::max(most, std::get<EncodedBatch>(decode_message(message)).tiles.size());
        }
        return most;
    };
    EXPECT_TRUE(has_batches("framelet"));
    EXPECT_LE(largest(20), 20u);
    EXPECT_GT(largest(20), 4u) << "of four rays a sample";
}

TEST_F(Table, EveryRunOfEverySceneGetsItsFigures) {
    PublishedTable const table{{"vehicle_fixed", "vehicle_chase"}, {{3, 4, 64, {53, 100}}, {6, 16, 64, {70, 100}}}};
    StudyOptions options = study(small_run({}, 20));
    options.methods = {"framed", "frameless", "framelet"};
    options.samples_per_side = 1;
    options.scenes = {bundled("vehicle_fixed"), bundled("vehicle_chase")};
    auto const figures = run_table(table, options);
    ASSERT_EQ(figures["cells"].size(), 2u * 2 * 2) << "framed is what the others are divided by";
    for (auto const& cell : figures["cells"]) {
        EXPECT_EQ(cell["ratios"].size(), 10u);
        EXPECT_GT(cell["median_ratio"].get<double>(), 0);
        double const spent = cell["cpu_seconds"]["server"].get<double>() + cell["cpu_seconds"]["viewer"].get<double>();
        EXPECT_LE(spent, 0.65) << "equal in total: " << cell;
        if (spent < 0.35) { // less is spent where everything is as fine as it gets, and what moves is small
            EXPECT_EQ(cell["method"], "framelet") << cell;
            EXPECT_EQ(cell["scene"], "vehicle_fixed") << cell;
            EXPECT_LT(cell["median_ratio"].get<double>(), 0.8) << "better all the same: " << cell;
        }
    }
    auto const ratios = [&](int i) { return figures["cells"][static_cast<std::size_t>(i)]["ratios"]; };
    EXPECT_EQ(ratios(0), ratios(1)) << "frameless knows no batches";
    EXPECT_NE(ratios(6), ratios(7)) << "framelet does";
    options.scenes = {bundled("windmill")};
    EXPECT_THROW(run_table(table, options), InputError);
}

} // namespace
} // namespace framelet::bench
