// The published table's file, choosing from it, and runs of it: small pictures, little time.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "common/error.h"
#include "protocol/message.h"
#include "tests/evaluation/method.h"
#include "tests/evaluation/table.h"

namespace framelet::bench {
namespace {

std::filesystem::path const source = FRAMELET_SOURCE_DIR;

PublishedTable published() {
    return read_published_table(source / "tests/evaluation/published_table_7_2.csv");
}

TEST(PublishedTable, IsTheDissertations) {
    PublishedTable const table = published();
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

TEST(PublishedTable, GivesThePartThatIsAskedFor) {
    PublishedTable const part = part_of(published(), {6, 0}, {"vehicle_crossing", "vehicle_fixed"});
    EXPECT_EQ(part.scenes, (std::vector<std::string>{"vehicle_fixed", "vehicle_crossing"}));
    ASSERT_EQ(part.runs.size(), 2u);
    EXPECT_EQ(part.runs[0].suitable, (std::vector<double>{16, 11}));
    EXPECT_EQ(part.runs[1].suitable, (std::vector<double>{70, 91}));
    EXPECT_EQ(part_of(published(), {}, {}).runs.size(), 16u);
    EXPECT_THROW(part_of(published(), {16}, {}), InputError);
    EXPECT_THROW(part_of(published(), {}, {"windmill"}), InputError);
}

TEST(PublishedTable, DamagedFilesAreRefused) {
    auto const file = std::filesystem::temp_directory_path() / ("framelet-table-" + std::to_string(getpid()));
    std::string const head = "run,batch,side,a,b\n";
    for (std::string const& text :
         {std::string(), head, std::string("0,32,256,1,2\n"), head + "0,32,256,1\n", head + "0,32,256,1,2,3\n",
          head + "0,32,256,1,x\n", head + "0,32,256,1,2x\n", head + "0,0,256,1,2\n", head + "0,32,256,1,101\n"}) {
        std::ofstream(file) << text;
        EXPECT_THROW(read_published_table(file), InputError) << text;
    }
    std::filesystem::remove(file);
    EXPECT_THROW(read_published_table(file), InputError);
}

TEST(Table, BatchesHaveNoMoreFrameletsThanTheRunSays) {
    auto const scene = load_bench_scene(source / "scenes/vehicle_chase.glb");
    CostTable const costs = read_cost_table(source / "tests/evaluation/costs.json");
    auto const largest = [&](std::size_t batch_framelets) {
        auto const method = make_method(
            "framelet", {.viewport = {128, 128}, .costs = costs, .machine = 0.1, .batch_framelets = batch_framelets});
        std::size_t most = 0;
        for (int step = 0; step < 6; ++step) {
            pose_at(*scene, 0.1 * step);
            auto const message =
                method->produce({*scene, 0.1 * step, 0.1 * step, {1, scene->camera, {128, 128}}, 0, {}}).message;
            if (message.empty()) { // it is sent with the next step
                continue;
            }
            most = std::max(most, std::get<EncodedBatch>(decode_message(message)).tiles.size());
        }
        return most;
    };
    EXPECT_TRUE(has_batches("framelet"));
    EXPECT_LE(largest(20), 20u);
    EXPECT_GT(largest(20), 10u);
}

TEST(Table, EveryRunOfEverySceneGetsItsFigures) {
    PublishedTable const table{{"vehicle_fixed", "vehicle_chase"}, {{3, 4, 64, {53, 100}}, {6, 16, 64, {70, 100}}}};
    StudyOptions study;
    study.methods = {"framed", "frameless", "framelet"};
    study.run.seconds = 0.5;
    study.run.reference_rate = 20;
    study.samples_per_side = 1;
    study.reference_cache = std::filesystem::temp_directory_path() / ("framelet-table-" + std::to_string(getpid()));
    study.costs = read_cost_table(source / "tests/evaluation/costs.json");
    auto const figures = run_table(table, source / "scenes", study);
    std::filesystem::remove_all(study.reference_cache);
    ASSERT_EQ(figures["cells"].size(), 2u * 2 * 2) << "framed is what the others are divided by";
    for (auto const& cell : figures["cells"]) {
        EXPECT_EQ(cell["ratios"].size(), 10u);
        EXPECT_GT(cell["median_ratio"].get<double>(), 0);
        double const spent = cell["cpu_seconds"]["server"].get<double>() + cell["cpu_seconds"]["viewer"].get<double>();
        EXPECT_NEAR(spent, 0.5, 0.15) << "equal in total: " << cell;
    }
    auto const ratios = [&](int i) { return figures["cells"][static_cast<std::size_t>(i)]["ratios"]; };
    EXPECT_EQ(ratios(0), ratios(1)) << "frameless knows no batches";
    EXPECT_NE(ratios(6), ratios(7)) << "framelet does";
}

} // namespace
} // namespace framelet::bench
