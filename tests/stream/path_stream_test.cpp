// Streams whose light is found by paths in the end (`--light reference`, `full`).
#include <cmath>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "common/morton.h"
#include "server/render/path/path_picture.h"
#include "server/stream/framelet_stream.h"
#include "tests/session/triangle_scenes.h"

namespace framelet {
namespace {

constexpr Viewport viewport{64, 48};
LightOptions const by_paths{LightMethod::reference, 0.53f, 0.1f}, by_cache{LightMethod::full, 0.53f, 0.1f};

/// A triangle on a floor, under a lamp.
Scene lit_scene() {
    Scene scene = moving_scene();
    Primitive floor;
    floor.positions = {{-4, -1, -1}, {4, -1, -1}, {4, -1, -9}, {-4, -1, -9}};
    floor.normals.assign(4, {0, 1, 0});
    floor.triangles = {{0, 1, 2}, {0, 2, 3}};
    scene.materials[0].metallic = 0;
    scene.meshes.push_back({"floor", {floor}, {}});
    scene.nodes.emplace_back();
    scene.nodes.back().mesh = 1;
    scene.nodes.emplace_back();
    scene.nodes.back().local.translation = {1, 2, -3};
    Light lamp;
    lamp.type = LightType::point;
    lamp.intensity = 12;
    lamp.node = 2;
    scene.lights.push_back(lamp);
    return scene;
}

class PathViewer {
public:
    explicit PathViewer(LightOptions const& by = by_paths, double samples_per_second = 4e5)
        : light(by), samples_per_second_(samples_per_second) {
        stream_.take({now_, ViewerSettings{}});
    }

    void look(Camera const& camera) { stream_.take({now_, CameraUpdate{{++cameras_, camera, viewport}, -1}}); }
    void cut() { stream_.take({now_, Resumed{acknowledged_}}); }

    /// One turn; returns what it was.
    Step turn(SceneTime present = 0, double clock_speed = 0) {
        Step const step = stream_.plan({now_, present, clock_speed, samples_per_second_, 1e-4}, posed);
        if (step == Step::render) {
            posed.pose(stream_.moment());
            stream_.render(posed);
            paths += stream_.planned_figures().rays;
            if (stream_.learn(posed)) {
                take(stream_.learnt_batch());
                EncodedBatch const encoded = stream_.encode();
                bytes += encoded.payload.size();
                stream_.take({now_, BatchSent{encoded.number, encoded.payload.size()}});
                stream_.take({now_ + 0.001, Ack{encoded.number, 0, 0}});
                acknowledged_ = encoded.number;
            }
        }
        now_ += 0.01;
        return step;
    }
    /// Until the picture is complete; returns whether it is.
    bool finish(SceneTime present = 0) {
        for (int turns = 0; turns < 20000 && !stream_.is_complete(); ++turns) {
            turn(present);
        }
        return stream_.is_complete();
    }

    LightOptions const light;
    Scene const scene = lit_scene();
    RenderScene render_scene{scene, Environment::uniform(Vec3(0.05f))};
    PosedScene posed{scene, {0}, render_scene, light};
    Picture picture{viewport.width, viewport.height}; ///< of the samples that came last, one a pixel
    std::uint64_t paths = 0, bytes = 0, batches = 0;

private:
    void take(Batch const& batch) {
        ImagePlane const plane(viewport);
        ++batches;
        for (DisplayFramelet const& framelet : batch.framelets) {
            EXPECT_LE(framelet.tile.depth(), plane.pixel_depth()) << "a path goes through any point of its pixel";
            PixelRect const rect = plane.tile_rect(framelet.tile);
            for (std::uint32_t i = 0; framelet.tile.depth() == plane.pixel_depth() && i < framelet_samples; ++i) {
                int const x = rect.left + static_cast<int>(morton_x(i)), y = rect.top + static_cast<int>(morton_y(i));
                if (x < viewport.width && y < viewport.height) {
                    std::array const rgba{framelet.red[i], framelet.green[i], framelet.blue[i], std::uint8_t{255}};
                    std::ranges::copy(rgba, picture.row(y) + std::ptrdiff_t{4} * x);
                }
            }
        }
    }

    double const samples_per_second_;
    FrameletStream stream_{{}, coding::all};
    double now_ = 10;
    std::uint64_t cameras_ = 0, acknowledged_ = 0;
};

TEST(PathStream, AtRestItIsThePictureOfThePaths) {
    PathViewer viewer;
    viewer.look({});
    ASSERT_TRUE(viewer.finish());
    EXPECT_EQ(viewer.turn(), Step::nothing) << "as good as it gets";
    PathOptions options;
    options.paths = 4096;
    options.seed = 5; // paths of its own
    options.sizes = lamp_sizes(by_paths, {});
    Picture const wanted = to_display(render_paths(viewer.render_scene, {}, viewport, options), 1);
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < wanted.rgba.size(); ++i) {
        double const off = static_cast<double>(viewer.picture.rgba[i]) - static_cast<double>(wanted.rgba[i]);
        sum += off;
        squares += off * off;
    }
    auto const count = static_cast<double>(wanted.rgba.size());
    EXPECT_LT(std::sqrt(squares / count), 255.0 / 512) << "the error at which it stops";
    EXPECT_LT(std::abs(sum / count), 0.05);
    double const pixels = viewport.width * viewport.height;
    EXPECT_LT(static_cast<double>(viewer.paths), 1024 * pixels) << "it stops where it is good enough";
    EXPECT_LT(static_cast<double>(viewer.bytes), 12 * 3 * pixels) << "at most eleven pictures come";
}

/// Whatever a viewer has seen before, how fast its server is, and on how many threads.
TEST(PathStream, AtRestAllViewersHaveTheSameBytes) {
    Camera const camera = look_at({0.2f, 0, 0}, {0, -0.2f, -5}, {0, 1, 0}, 0.9f);
    PathViewer fresh;
    fresh.look(camera);
    ASSERT_TRUE(fresh.finish(0.5));
    for (std::size_t const threads : {1u, 2u}) {
        tbb::global_control const limit(tbb::global_control::max_allowed_parallelism, threads);
        PathViewer flying(by_paths, 3e4);
        for (int i = 0; i < 40; ++i) {
            Camera moved = camera;
            moved.position.x += 0.05f * static_cast<float>(40 - i);
            flying.look(moved);
            flying.turn(0.01 * i, 1);
        }
        flying.look(camera);
        for (int i = 0; i < 300; ++i) {
            flying.turn(0.5); // at rest for a while
        }
        flying.cut();
        Camera aside = camera;
        aside.position.x += 1;
        flying.look(aside);
        flying.turn(0.5);
        flying.look(camera); // and back, with sums of half the paths
        ASSERT_TRUE(flying.finish(0.5));
        EXPECT_EQ(flying.picture.rgba, fresh.picture.rgba) << threads << " threads";
    }
}

double root_mean_square(Picture const& a, Picture const& b) {
    double squares = 0;
    for (std::size_t i = 0; i < a.rgba.size(); ++i) {
        double const off = static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]);
        squares += off * off / static_cast<double>(a.rgba.size());
    }
    return std::sqrt(squares);
}

TEST(PathStream, LightOfTheCacheIsSmoothAtOnceAndThatOfThePathsInTheEnd) {
    PathViewer paths;
    paths.look({});
    ASSERT_TRUE(paths.finish());
    PathViewer viewer(by_cache, 3e4);
    for (int i = 0; i < 40; ++i) {
        Camera moved;
        moved.position.x += 0.05f * static_cast<float>(40 - i);
        viewer.look(moved);
        viewer.turn(0.01 * i, 1);
    }
    viewer.look({});
    viewer.cut();
    for (int i = 0; i < 60; ++i) {
        viewer.turn();
    }
    EXPECT_LT(root_mean_square(viewer.picture, paths.picture), 4);
    ASSERT_TRUE(viewer.finish());
    EXPECT_EQ(viewer.picture.rgba, paths.picture.rgba);
    EXPECT_EQ(viewer.turn(), Step::nothing);
}

TEST(PathStream, WhileAnythingMovesItGoesOnFromMomentToMoment) {
    PathViewer viewer;
    viewer.look({});
    for (int i = 0; i < 200; ++i) {
        viewer.turn(0.01 * i, 1);
    }
    EXPECT_GT(viewer.batches, 20u);
    ASSERT_TRUE(viewer.finish(1.99));
}

} // namespace
} // namespace framelet
