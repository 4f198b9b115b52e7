// Tests the engine of the evaluation: virtual clock, methods, costs. Small pictures, little time.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "common/error.h"
#include "tests/evaluation/ablation.h"
#include "tests/evaluation/methods/kd_leaves.h"
#include "tests/evaluation/small_run.h"

namespace framelet::bench {
namespace {

class Evaluation : public SmallRuns {
protected:
    std::unique_ptr<BenchScene> scene = load_bench_scene(bundled("vehicle_chase"));
};

TEST_F(Evaluation, TheSameSeedGivesTheSameFigures) {
    RunParameters parameters = small_run({64, 48}, 40);
    parameters.link.bits_per_second = 5e6;
    parameters.link.delay_seconds = 0.02;
    parameters.link.jitter_seconds = 0.01;
    parameters.link.stalls = {{0.2, 0.1}};
    Reference const truth = reference(*scene, parameters);
    auto const run = [&] { return to_json(compare_methods(*scene, truth, method_names(), parameters, costs)).dump(); };
    std::string const once = run();
    EXPECT_EQ(once, run());
    EXPECT_EQ(once.find("null"), std::string::npos) << "not a number";
}

TEST_F(Evaluation, FramedReachesTheRateThatTheMachineIsStatedBy) {
    for (double const rate : {5.0, 20.0}) {
        RunParameters parameters = small_run({64, 48}, 40);
        parameters.seconds = 2;
        parameters.frames_per_second = rate;
        parameters.rivals = plain_rivals; // the plain frames by which the machine's speed is defined
        std::size_t times = 0;
        RunResult const result = show(*scene, "framed", parameters, [&](std::size_t index, Picture const&, double age) {
            EXPECT_EQ(index, times++);
            EXPECT_GE(age, 0);
        });
        EXPECT_EQ(times, 80u);
        EXPECT_NEAR(static_cast<double>(result.messages), 2 * rate, 0.1 * rate + 1);
        EXPECT_NEAR(result.cpu.server(), 2, 0.3) << "busy all the time";
    }
}

TEST_F(Evaluation, EveryMethodSpendsTheSameOnTheServer) {
    RunParameters parameters = small_run({64, 48}, 40);
    parameters.seconds = 1;
    for (MethodRecord const& record : records(*scene, method_names(), parameters)) {
        EXPECT_NEAR(record.run.cpu.server(), 1, 0.15) << record.method;
        EXPECT_GT(record.run.bytes, 0u) << record.method;
    }
}

TEST_F(Evaluation, AStillSceneIsShownWithoutError) {
    auto const still = load_bench_scene(bundled("vehicle_fixed"));
    RunParameters parameters = small_run({64, 48}, 40);
    parameters.seconds = 0.05; // the lead-in is over, nothing to speak of has moved
    parameters.frames_per_second = 30;
    pose_at(*still, 0);
    Picture const first = render_picture(*still->render_scene, still->camera, parameters.viewport, still->exposure, 1);
    for (std::string const name : {"framed", "frameless", "afr"}) {
        parameters.rivals = plain_rivals; // one sample a pixel, as `first` has
        show(*still, name, parameters, [&](std::size_t index, Picture const& shown, double) {
            if (index == 0) {
                EXPECT_LT(mean_squared_error(shown, first), 1e-6) << name;
            }
        });
    }
}

TEST_F(Evaluation, ALinkDelaysWhatIsShown) {
    RunParameters parameters = small_run({64, 48}, 40);
    auto const age_with = [&](double delay) {
        parameters.link.delay_seconds = delay;
        double sum = 0;
        // A method without reprojection: one that moves its framelets may hold them longer.
        show(*scene, "framelet-unwarped", parameters,
             [&](std::size_t, Picture const&, double age) { sum += age / 20; });
        return sum;
    };
    double const near = age_with(0);
    double const far = age_with(0.1);
    EXPECT_GT(far, near + 0.05);
    EXPECT_LT(far, near + 0.25);
}

/// Ages of what is shown in the last part of a run whose link has lost most of its rate.
/// Sends nothing; notes what a server hears.
class Listener final : public Method {
public:
    struct Heard {
        double now = 0;
        SceneTime time = 0;
        bool clock_set = false;
    };
    std::vector<Heard> heard;

    ServerStep produce(StepInput const& input) override {
        heard.push_back({input.now, input.time, input.clock_set});
        return {};
    }
    ViewerStep consume(std::vector<std::byte> const&) override { return {}; }
    Picture const& picture() const override { return picture_; }
    double mean_sample_time() const override { return 0; }

private:
    Picture picture_{1, 1};
};

TEST_F(Evaluation, AServerHearsOfASetClockOneDelayLateAndNothingBefore) {
    RunParameters run = small_run({16, 16}, 10);
    run.start = 1;
    run.link.delay_seconds = 0.1;
    run.clock_settings = {{0.199, 3}};
    Listener listener;
    std::vector<double> shown; // scene times, as the age of what is of time 0
    run_method(*scene, listener, run, 1, [&](std::size_t, Picture const&, double age) { shown.push_back(age); });
    std::vector<double> const expected{1, 1.1, 3.001, 3.101, 3.201};
    ASSERT_EQ(shown.size(), expected.size());
    for (std::size_t i = 0; i < shown.size(); ++i) {
        EXPECT_NEAR(shown[i], expected[i], 1e-9);
    }
    int settings = 0;
    for (Listener::Heard const& heard : listener.heard) {
        bool const knows = heard.now >= 0.299;
        EXPECT_NEAR(heard.time, knows ? 2.801 + heard.now : 1 + std::max(heard.now, -0.5), 1e-9) << heard.now;
        EXPECT_EQ(heard.clock_set, knows && settings == 0) << heard.now;
        settings += heard.clock_set ? 1 : 0;
    }
    EXPECT_EQ(settings, 1);
}

TEST_F(Evaluation, AStudySetsTheClockOfItsReferenceToo) {
    StudyOptions options = study(small_run({32, 18}, 8));
    options.events = Events::set;
    Subject const set = prepare(bundled("teleport"), options);
    EXPECT_EQ(set.run.clock_settings.size(), 1u);
    auto const still = load_bench_scene(bundled("teleport"));
    pose_at(*still, 1.1);
    EXPECT_EQ(set.reference.picture(3), render_reference(*still, options.run.viewport, options.samples_per_side));
    EXPECT_NE(set.reference.picture(2), set.reference.picture(3));
}

TEST_F(Evaluation, AStudyFliesAlongAHandAndWithoutPerspective) {
    StudyOptions options = study(small_run({16, 16}, 2));
    options.camera = source / "tests/evaluation/flights/hand.json";
    options.orthographic_height = 8;
    Subject const subject = prepare(bundled("windmill"), options);
    EXPECT_EQ(subject.scene->followed_camera(), -1);
    EXPECT_EQ(own_camera_at(*subject.scene, 1).projection, Projection::orthographic);
    float fastest = 0, still = 0;
    for (double time = 0; time < 3.9; time += 0.02) {
        Camera const one = camera_at(*subject.scene, time), next = camera_at(*subject.scene, time + 0.02);
        EXPECT_EQ(one.vertical_extent, 8);
        float const turn = std::acos(std::min(1.0f, glm::dot(one.forward(), next.forward())));
        fastest = std::max(fastest, turn / 0.02f);
        still += turn < 1e-3f ? 0.02f : 0;
    }
    EXPECT_GT(glm::degrees(fastest), 300) << "a jerk";
    EXPECT_GT(still, 0.8f) << "and rests";
}

TEST_F(Evaluation, CodedFramesFollowTheLinkDown) {
    RunParameters parameters = small_run({64, 48}, 40);
    parameters.viewport = {128, 128};
    parameters.seconds = 3;
    parameters.link.bits_per_second = 4e6;
    parameters.link.delay_seconds = 0.02;
    auto const run_at_end = [&](std::vector<RateStep> steps) {
        parameters.link.rate_steps = std::move(steps);
        double age_sum = 0;
        RunResult const result =
            show(*scene, "framed+h264", parameters,
                 [&](std::size_t index, Picture const&, double age) { age_sum += index >= 80 ? age / 40 : 0; });
        return std::pair(age_sum, result.bytes);
    };
    auto const [age, bytes] = run_at_end({});
    auto const [narrow_age, narrow_bytes] = run_at_end({{0.5, 0.25e6}});
    EXPECT_LT(narrow_age, age + 0.12) << "a queue would hold its frames up for seconds";
    EXPECT_LT(narrow_bytes, bytes / 2);
    EXPECT_GT(static_cast<double>(narrow_bytes), 0.6 * 2.5 * 0.25e6 / 8) << "the link is used";
}

TEST_F(Evaluation, PartsAreLeftOutOneAtATime) {
    StudyOptions options = study(small_run({64, 48}, 20));
    options.scenes = {bundled("vehicle_chase")};
    nlohmann::json const figures = measure_ablation(options, {"reprojection", "kept cuts", "byte prices"});
    std::vector<std::string> rows;
    for (nlohmann::json const& row : figures["rows"]) {
        rows.push_back(row["link"].get<std::string>() + ' ' + row["part"].get<std::string>());
        if (row["part"] == "whole") {
            EXPECT_EQ(row["ratio"]["mse"], 1);
            EXPECT_EQ(row["ratio"]["standard_error"], 0);
        } else if (row["part"] == "reprojection") {
            EXPECT_GT(row["ratio"]["mse"], 1.5) << "of what all others are parts of";
        } else if (row["part"] == "kept cuts") {
            EXPECT_EQ(row["ratio"]["mse"], 1) << "there is none";
        }
    }
    EXPECT_EQ(rows, (std::vector<std::string>{"free whole", "free reprojection", "free kept cuts", "link whole",
                                              "link reprojection", "link kept cuts", "link byte prices"}));
}

TEST_F(Evaluation, ReferencesAreKeptAndMadeAgainWhenTheyAreWrong) {
    RunParameters const parameters = small_run({64, 48}, 40);
    Picture const first = reference(*scene, parameters).picture(0);
    auto const file = reference(*scene, parameters).folder() / "00000.png";
    auto const written = std::filesystem::last_write_time(file);
    reference(*scene, parameters);
    EXPECT_EQ(std::filesystem::last_write_time(file), written);
    std::filesystem::copy_file(reference(*scene, parameters).folder() / "00019.png", file,
                               std::filesystem::copy_options::overwrite_existing);
    EXPECT_EQ(reference(*scene, parameters).picture(0), first);
}

TEST(EvaluationInput, BadOnesAreRefusedInOneLine) {
    EXPECT_THROW(make_method("magic", {}), InputError);
    EXPECT_THROW(load_bench_scene(bundled("no such scene")), InputError);
    auto const file = std::filesystem::temp_directory_path() / "framelet-costs-test.json";
    for (char const* const text : {"", "[]", "{}", "{\"coherent_segment\": -1}"}) {
        std::ofstream(file) << text;
        EXPECT_THROW(read_cost_table(file), InputError) << text;
    }
    std::filesystem::remove(file);
    EXPECT_THROW(read_cost_table(file), InputError);
}

double area_of(KdLeaves const& leaves) {
    double area = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        EXPECT_FALSE(leaves.rect(i).empty());
        area += static_cast<double>(leaves.rect(i).width()) * leaves.rect(i).height();
    }
    return area;
}

TEST(KdLeaves, CoverThePictureKeepTheirNumberAndGatherWhereItVaries) {
    KdLeaves leaves({100, 60}, 64);
    std::size_t const count = leaves.size();
    EXPECT_EQ(area_of(leaves), 6000);
    std::uint32_t noise = 1;
    for (int step = 0; step < 300; ++step) {
        for (std::size_t leaf = 0; leaf < leaves.size(); ++leaf) {
            noise = noise * 1664525u + 1013904223u;
            bool const busy = leaves.rect(leaf).left < 30;
            leaves.add(leaf, step * 0.01, busy ? static_cast<float>(noise >> 8) * 0x1p-24f : 0.5f);
        }
        leaves.adapt(3);
        ASSERT_EQ(leaves.size(), count);
    }
    EXPECT_EQ(area_of(leaves), 6000);
    std::size_t busy = 0;
    for (std::size_t i = 0; i < leaves.size(); ++i) {
        busy += leaves.rect(i).left < 30;
    }
    EXPECT_GT(busy, count * 2 / 3);
}

} // namespace
} // namespace framelet::bench
