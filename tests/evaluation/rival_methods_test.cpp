// Tests the rivals at their best: what each of their parts is for, with known answers.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/color.h"
#include "tests/evaluation/methods/frame_forecast.h"
#include "tests/evaluation/methods/frame_grid.h"
#include "tests/evaluation/methods/interruptible.h"
#include "tests/evaluation/methods/whole_frame.h"
#include "tests/evaluation/rival_choice.h"
#include "tests/evaluation/small_run.h"

namespace framelet::bench {
namespace {

MethodSetup setup_of(Viewport viewport, RivalParts rivals) {
    MethodSetup setup;
    setup.viewport = viewport;
    setup.costs = usual_costs();
    setup.rivals = rivals;
    return setup;
}

class Rivals : public SmallRuns {
protected:
    MethodRecord record(BenchScene& scene, std::string const& method, RunParameters const& run) const {
        return records(scene, {method}, run).front();
    }
};

TEST(RivalChoice, TheBestOneIsTheLeast) {
    EXPECT_EQ(best_choice({3, 1, 2}), 1u);
    EXPECT_EQ(best_choice({2, 2}), 0u);
    EXPECT_EQ(rival_choices("framed", {}).size(), 3u);
    EXPECT_EQ(rival_choices("framed+warp", {}).size(), 6u);
    EXPECT_EQ(rival_choices("framed+warp", plain_rivals).size(), 1u);
    EXPECT_EQ(rival_choices("framelet", {}).size(), 1u);
    for (RivalParts const& choice : rival_choices("framed+warp", {})) {
        EXPECT_GT(choice.spacing, 0);
        EXPECT_GE(choice.margin, 0);
    }
}

TEST_F(Rivals, TheRecordIsOfTheSpacingWithTheLeastError) {
    auto const scene = load_bench_scene(bundled("vehicle_chase"));
    RunParameters parameters = small_run({96, 64}, 20);
    MethodRecord const chosen = record(*scene, "framed+h264", parameters);
    double least = INFINITY;
    int best = 0;
    for (int const spacing : {1, 2, 4}) {
        parameters.rivals.spacing = spacing;
        double const error = mean_mse(record(*scene, "framed+h264", parameters));
        best = error < least ? spacing : best;
        least = std::min(least, error);
    }
    EXPECT_EQ(chosen.rivals.spacing, best);
    EXPECT_EQ(mean_mse(chosen), least);
}

TEST(Upsampling, IsLinearInLight) {
    Picture coarse(2, 1);
    for (std::size_t c = 0; c < 3; ++c) {
        coarse.rgba[c] = srgb_byte_from_linear(0.2f);
        coarse.rgba[4 + c] = srgb_byte_from_linear(0.6f);
    }
    Picture fine(8, 4);
    upsample(coarse, 4, fine);
    float const first = linear_from_srgb_byte(coarse.rgba[0]);
    float const second = linear_from_srgb_byte(coarse.rgba[4]);
    for (int x = 0; x < 8; ++x) {
        float const share = std::clamp((static_cast<float>(x) - 1.5f) / 4, 0.0f, 1.0f);
        int const expected = srgb_byte_from_linear(first + share * (second - first));
        EXPECT_NEAR(fine.row(2)[4 * x], expected, 1) << x;
    }
    Picture same(2, 1);
    upsample(coarse, 1, same);
    EXPECT_EQ(same, coarse);
}

TEST(FrameGrid, TheMeanOfAllOffsetsIsTheStratifiedPicture) {
    auto const scene = load_bench_scene(bundled("vehicle_fixed"));
    Viewport const viewport{80, 48};
    FrameGrid grid(viewport, 1);
    Picture const truth = render_reference(*scene, viewport, 16);
    std::vector<double> errors;
    grid.render(*scene->render_scene, scene->camera, scene->exposure);
    EXPECT_EQ(grid.picture(), render_picture(*scene->render_scene, scene->camera, viewport, scene->exposure, 1));
    for (int frames = 1; frames <= FrameGrid::offsets; ++frames) {
        errors.push_back(mean_squared_error(grid.picture(), truth));
        grid.add(*scene->render_scene, scene->camera, scene->exposure);
    }
    EXPECT_LT(errors[3], 0.5 * errors[0]);
    EXPECT_LT(errors[15], 0.5 * errors[3]);
    EXPECT_GT(psnr_from_mse(errors.back()), 38);
}

TEST_F(Rivals, APictureThatStandsStillBecomesAsGoodAsTheReference) {
    auto const scene = load_bench_scene(bundled("teleport"));
    RunParameters parameters = small_run({64, 48}, 20);
    parameters.frames_per_second = 400; // fast enough to converge in the half second before the measured time
    parameters.seconds = 0.05; // only the first reference time is looked at
    pose_at(*scene, 0);
    Picture const truth = render_reference(*scene, parameters.viewport, 16);
    for (std::string const name : {"framed", "framed+h264", "framed+warp", "interruptible"}) {
        for (RivalParts const& choice : rival_choices(name, {})) {
            parameters.rivals = choice;
            show(*scene, name, parameters, [&](std::size_t index, Picture const& shown, double) {
                if (index == 0) {
                    EXPECT_GT(psnr_from_mse(mean_squared_error(shown, truth)), 38)
                        << name << ", a sample every " << choice.spacing << " pixels, margin " << choice.margin;
                }
            });
        }
    }
}

TEST_F(Rivals, NothingIsSentOnceThePictureIsAsGoodAsItGets) {
    auto const scene = load_bench_scene(bundled("teleport"));
    RunParameters parameters = small_run({48, 32}, 20);
    parameters.frames_per_second = 400;
    parameters.seconds = 1;
    parameters.scene_stops = 0;
    parameters.link.bits_per_second = 5e6;
    for (std::string const name : {"framed", "framed+h264", "framed+warp", "interruptible"}) {
        for (RunResult::Delivery const& delivery : record(*scene, name, parameters).run.deliveries) {
            EXPECT_LT(delivery.sent, 0.5) << name;
        }
    }
}

/// The picture of a running scene is, on the average, neither early nor late.
TEST_F(Rivals, FramesAreOfTheMiddleOfTheirTimeOnDisplay) {
    auto const scene = load_bench_scene(bundled("vehicle_chase"));
    RunParameters parameters = small_run({64, 48}, 60);
    parameters.seconds = 1.5;
    parameters.link = {.bits_per_second = 20e6, .delay_seconds = 0.05};
    for (bool const ahead : {false, true}) {
        parameters.rivals = {false, ahead, 1, 0};
        MethodRecord const found = record(*scene, "framed+h264", parameters);
        double mean = 0;
        for (std::size_t i = 30; i < found.ages.size(); ++i) {
            mean += found.ages[i] / static_cast<double>(found.ages.size() - 30);
        }
        EXPECT_NEAR(mean, ahead ? 0 : 0.2, 0.02);
    }
}

TEST(FrameForecast, KnowsTheScenesCameraAndFollowsTheViewers) {
    auto const scene = load_bench_scene(bundled("vehicle_chase"));
    MethodSetup setup = setup_of({64, 48}, {});
    setup.delay_seconds = 0.05;
    for (double const speed : {0.0, 40.0}) {
        scene->turn = {.degrees_per_second = speed, .reach_degrees = 170};
        FrameForecast forecast(setup, 0.01);
        std::vector<DeliveredMessage> const none;
        FrameMoment moment;
        double now = 0;
        for (; now < 0.75; now += 0.1) { // frames take 0.08 s to render and 0.05 s to arrive
            Camera const seen = camera_at(*scene, std::max(0.0, now - 0.05));
            moment = forecast.moment({*scene, now, now, {1, seen, setup.viewport}, 0, none});
            forecast.begin(now, true);
            forecast.sent(now + 0.08);
            forecast.answered(now + 0.13);
        }
        now -= 0.1;
        EXPECT_NEAR(moment.time, now + 0.14 + 0.05, 1e-3);
        Camera const there = camera_at(*scene, moment.time);
        EXPECT_LT(glm::distance(moment.camera.position, there.position), 1e-4f);
        // The turn is extrapolated for 0.2 s of the 0.24 s since the camera that the server knows.
        double const late = 0.04 * speed;
        float const cosine = glm::dot(moment.camera.forward(), there.forward());
        EXPECT_NEAR(glm::degrees(std::acos(std::min(cosine, 1.0f))), late, 0.15) << speed;
    }
}

TEST(FrameForecast, ASetClockIsNoMotionOfTheViewersAndTheLensIsTheirs) {
    auto const scene = load_bench_scene(bundled("vehicle_chase"));
    MethodSetup setup = setup_of({64, 48}, {});
    setup.delay_seconds = 0.05;
    FrameForecast forecast(setup, 0.01);
    std::vector<DeliveredMessage> const none;
    for (int step = 0; step < 7; ++step) {
        double const now = 0.1 * step;
        double const time = now + (step >= 3 ? 2 : 0);
        Camera seen = camera_at(*scene, std::max(0.0, time - 0.05));
        seen.vertical_extent = 0.5f;
        FrameMoment const moment = forecast.moment({*scene, time, now, {1, seen, setup.viewport}, 0, none, step == 3});
        EXPECT_LT(glm::distance(moment.camera.position, own_camera_at(*scene, moment.time).position), 1e-3f) << step;
        EXPECT_EQ(moment.camera.vertical_extent, 0.5f) << step;
        forecast.begin(now, true);
        forecast.sent(now + 0.08);
        forecast.answered(now + 0.13);
    }
}

TEST(Margin, ShowsTheSamePixelsAndThoseAround) {
    auto const scene = load_bench_scene(bundled("vehicle_fixed"));
    Viewport const viewport{96, 64};
    int const x = margin_pixels(0.125, viewport.width);
    int const y = margin_pixels(0.125, viewport.height);
    EXPECT_EQ(x, 16);
    EXPECT_EQ(y, 16);
    EXPECT_EQ(margin_pixels(0, 96), 0);
    FrameGrid narrow(viewport, 1);
    FrameGrid wide(with_margin(viewport, x, y), 1);
    narrow.render(*scene->render_scene, scene->camera, scene->exposure);
    wide.render(*scene->render_scene, with_margin(scene->camera, viewport, y), scene->exposure);
    Picture const& inner = narrow.picture();
    Picture const& outer = wide.picture();
    double sum = 0;
    for (int row = 0; row < viewport.height; ++row) {
        for (int byte = 0; byte < 4 * viewport.width; ++byte) {
            double const off = inner.row(row)[byte] - outer.row(row + y)[byte + 4 * x];
            sum += off * off;
        }
    }
    EXPECT_LT(sum / (255.0 * 255 * 3 * viewport.width * viewport.height), 1e-5) << "rounding of edges apart";
}

/// No message of the run knows of the turn, which goes no further than the margin.
TEST_F(Rivals, APanShowsNoHoleWithinTheMargin) {
    auto const scene = load_bench_scene(bundled("teleport"));
    scene->turn = {.degrees_per_second = 20, .reach_degrees = 30};
    RunParameters parameters = small_run({96, 64}, 20);
    parameters.seconds = 0.25; // the camera turns by five degrees
    parameters.link.delay_seconds = 0.3;
    parameters.frames_per_second = 60;
    Reference const truth = reference(*scene, parameters);
    auto const edge_error = [&](double margin) {
        parameters.rivals = {true, true, 1, margin};
        double sum = 0;
        show(*scene, "framed+warp", parameters, [&](std::size_t index, Picture const& shown, double) {
            if (index == 0) {
                return;
            }
            Picture const exact = truth.picture(index);
            for (int y = 0; y < shown.height; ++y) {
                for (int x = 0; x < 4 * 6; ++x) { // pixels at the side that comes into view
                    double const off = shown.row(y)[x] - exact.row(y)[x];
                    sum += off * off;
                }
            }
        });
        return sum;
    };
    double const with = edge_error(0.125);
    double const without = edge_error(0);
    EXPECT_LT(with, 0.5 * without);
}

TEST(Interruptible, GoesFromCoarseToFineAndBeginsAnewOnlyAtTheBeginning) {
    auto const scene = load_bench_scene(bundled("vehicle_chase"));
    RunParameters parameters = small_run({96, 64}, 20);
    parameters.frames_per_second = 60;
    CostTable const costs = usual_costs();
    double const machine = machine_factor(*scene, parameters, costs);
    Interruptible method(method_setup(parameters, machine, costs));
    int before = -1;
    int begun = 0;
    run_method(
        *scene, method, parameters, machine, [](std::size_t, Picture const&, double) {},
        [&](double start, ServerStep const& step) {
            if (step.samples == 0) {
                return;
            }
            int const level = method.level();
            EXPECT_TRUE(method.begins() || level == before + 1 || (level == before && level == 2)) << before << level;
            EXPECT_EQ(step.samples, FrameGrid(parameters.viewport, 4 >> level).samples());
            begun += start > 0.1 && method.begins() ? 1 : 0;
            before = level;
        });
    EXPECT_GT(begun, 10) << "everything moves";
}

} // namespace
} // namespace framelet::bench
