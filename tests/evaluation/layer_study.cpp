#include "tests/evaluation/layer_study.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "protocol/batch_codec.h"
#include "server/layers/layer_fit.h"
#include "server/schedule/tiling.h"
#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr float later_seconds = 0.1f;
constexpr float parallax_pixels = 20, yaw_radians = 0.0872665f;

/// Counts over all views of a scene.
struct Counts {
    double tiles = 0, sky = 0, one_plane = 0, few_planes = 0, no_loose = 0;
    double samples = 0, loose = 0, flowing = 0, reflecting = 0;
    double off = 0, off_later = 0; ///< samples shown too far off, at once and a tenth of a second later
    double wire_bytes = 0; ///< of the shapes
    double layers = 0;
    float farthest = 0; ///< pixels
    std::vector<double> nanoseconds; ///< a sample, three figures a view
};

/// Where samples are shown from another camera at another time.
class Reprojection {
public:
    /// Both poses are of the bodies; what no body carries moves on for `seconds`.
    Reprojection(SceneBodies const& bodies, ScenePose const& now, ScenePose const& later, float seconds,
                 Camera const& from, Viewport viewport, float move)
        : from_(from), seconds_(seconds), rays_(make_view_rays(from, viewport)),
          pixels_per_unit_(1 / glm::length(rays_.direction_dx)) {
        eye_ = from.position + from.right() * move;
        Quat const turned = from.orientation * glm::angleAxis(yaw_radians, Vec3(0, 1, 0));
        axes_ = Mat3(turned * Vec3(1, 0, 0), turned * Vec3(0, -1, 0), turned * Vec3(0, 0, -1));
        for (std::size_t body = 0; body < bodies.frames.size(); ++body) {
            auto const number = static_cast<BodyNumber>(body);
            poses_.emplace_back(body_pose(bodies, now, number), body_pose(bodies, later, number));
        }
    }

    /// Place in the picture, pixels from its middle, of what is seen at `place` at that inverse depth.
    Vec2 shown(Vec2 place, float inverse_depth, BodyNumber body, Vec3 const& velocity) const {
        Vec3 const direction = rays_.direction + rays_.direction_dx * place.x + rays_.direction_dy * place.y;
        Vec3 towards = direction;
        if (inverse_depth > 0) {
            Vec3 point = from_.position + direction / inverse_depth;
            auto const& [now, later] = poses_[body];
            if (body != static_body) {
                Vec3 const in_body = (glm::conjugate(now.rotation) * (point - now.translation)) / now.scale;
                point = later.rotation * (later.scale * in_body) + later.translation;
            }
            towards = (point + velocity * seconds_ - eye_) * inverse_depth;
        }
        Vec3 const p = towards * axes_;
        return p.z > 0.05f ? Vec2(p) * (pixels_per_unit_ / p.z) : Vec2(NAN); // behind the eye, or nearly
    }

private:
    Camera from_;
    float seconds_;
    ViewRays rays_;
    float pixels_per_unit_;
    Vec3 eye_;
    Mat3 axes_;
    std::vector<std::pair<BodyPose, BodyPose>> poses_;
};

/// Largest distance between where a framelet's samples are shown by their layers and by themselves, pixels.
float largest_error(Framelet const& framelet, FrameletShape const& shape, ImagePlane const& plane,
                    Reprojection const& reprojection, float allowed, double& off) {
    PixelRect const rect = plane.tile_rect(framelet.tile);
    float const spacing = plane.sample_spacing(framelet.tile);
    float largest = 0;
    for (std::uint32_t i = 0; i < framelet_samples; ++i) {
        if (shape.layer_of[i] == FrameletShape::loose) {
            continue;
        }
        Layer const& layer = shape.layers[shape.layer_of[i]];
        Vec2 const in_tile = (Vec2(morton_x(i), morton_y(i)) + 0.5f) * spacing;
        Vec2 const place = Vec2(rect.left, rect.top) + in_tile;
        float const by_layer = layer.at + layer.dx * in_tile.x + layer.dy * in_tile.y;
        Vec3 const velocity = framelet.velocity.empty() ? Vec3(0) : framelet.velocity[i];
        float const error = glm::distance(reprojection.shown(place, by_layer, layer.body, layer.velocity),
                                          reprojection.shown(place, 1 / framelet.depth[i], layer.body, velocity));
        largest = std::max(largest, std::isnan(error) ? 0.0f : error);
        off += error > allowed ? 1 : 0;
    }
    return largest;
}

/// What the shapes of a batch take on the wire.
double wire_bytes(std::span<Framelet const> framelets, std::vector<FrameletShape> shapes, Viewport viewport) {
    Batch batch;
    batch.view.viewport = viewport;
    for (Framelet const& framelet : framelets) {
        batch.framelets.emplace_back().tile = framelet.tile;
    }
    batch.shapes = std::move(shapes);
    return static_cast<double>(BatchCodec().encode(batch).shapes.size());
}

void count(Framelet const& framelet, FrameletShape const& shape, float error, float allowed, Counts& counts) {
    bool const sky = std::ranges::all_of(framelet.depth, [](float depth) { return std::isinf(depth); });
    bool const planes = shape.loose_samples.empty() && error <= allowed;
    ++counts.tiles;
    counts.sky += sky ? 1 : 0;
    counts.one_plane += !sky && planes && shape.layer_count == 1 ? 1 : 0;
    counts.few_planes += planes && shape.layer_count <= 2 ? 1 : 0;
    counts.no_loose += planes ? 1 : 0;
    counts.samples += framelet_samples;
    counts.loose += static_cast<double>(shape.loose_samples.size());
    counts.flowing += static_cast<double>(
        std::ranges::count_if(framelet.velocity, [](Vec3 const& velocity) { return velocity != Vec3(0); }));
    counts.reflecting += static_cast<double>(framelet.reflects.count());
    counts.layers += shape.layer_count;
    counts.farthest = std::max(counts.farthest, error);
}

void measure_view(BenchScene& scene, Camera const& camera, LayerStudy const& study, Counts& counts) {
    ImagePlane const plane(study.viewport);
    Tiling const tiling = make_uniform_tiling(plane, plane.pixel_depth());
    std::vector<Framelet> framelets(tiling.tiles.size());
    render_framelets(*scene.render_scene, camera, plane, tiling.tiles, 0, framelets);
    ViewRays const rays = make_view_rays(camera, study.viewport);
    float const depth = median_depth(framelets);
    LayerTolerance const tolerance = layer_tolerance(depth, rays);
    std::vector<FrameletShape> shapes(framelets.size());
    for (int round = 0; round < 3; ++round) {
        double const seconds = seconds_of([&] {
            for (std::size_t i = 0; i < framelets.size(); ++i) {
                fit_layers(framelets[i], plane, tolerance, shapes[i]);
            }
        });
        counts.nanoseconds.push_back(1e9 * seconds / static_cast<double>(framelets.size() * framelet_samples));
    }
    float const move = parallax_pixels * depth * glm::length(rays.direction_dx);
    ScenePose const later = evaluate_pose(scene.scene, scene.clips, scene.pose.time + later_seconds);
    SceneBodies const& bodies = scene.render_scene->bodies();
    Reprojection const at_once(bodies, scene.pose, scene.pose, 0, camera, study.viewport, move);
    Reprojection const in_motion(bodies, scene.pose, later, later_seconds, camera, study.viewport, move);
    auto const allowed = static_cast<float>(study.pixels);
    for (std::size_t i = 0; i < framelets.size(); ++i) {
        float const error = largest_error(framelets[i], shapes[i], plane, at_once, allowed, counts.off);
        largest_error(framelets[i], shapes[i], plane, in_motion, allowed, counts.off_later);
        count(framelets[i], shapes[i], error, allowed, counts);
    }
    counts.wire_bytes += wire_bytes(framelets, std::move(shapes), study.viewport);
}

Counts measure_scene(BenchScene& scene, LayerStudy const& study) {
    constexpr std::size_t most_cameras = 2;
    scene.render_scene->set_clips(scene.clips);
    Counts counts;
    int const times = scene.duration > 0 ? study.times : 1;
    Camera const around = default_camera(scene_bounds(scene.scene, evaluate_pose(scene.scene, scene.clips, 0)));
    for (int k = 0; k < times; ++k) {
        pose_at(scene, scene.duration * (k + 0.5) / times);
        measure_view(scene, around, study, counts);
        for (std::size_t c = 0; c < std::min(most_cameras, scene.scene.cameras.size()); ++c) {
            measure_view(scene, scene_camera(scene.scene, scene.pose, static_cast<Index>(c)), study, counts);
        }
    }
    return counts;
}

} // namespace

json measure_layers(LayerStudy const& study) {
    std::printf("%dx%d, a sample per pixel, %g pixels\n", study.viewport.width, study.viewport.height, study.pixels);
    std::printf("%-18s bodies   sky  1 plane  <=2 planes  no loose  loose samples  velocity  mirror  layers  farthest "
                "[px]    off  off later  bytes  ns/sample\n",
                "");
    json rows;
    for (std::filesystem::path const& file : study.scenes) {
        auto const scene = load_bench_scene(file);
        Counts const c = measure_scene(*scene, study);
        std::size_t const bodies = scene->render_scene->bodies().frames.size() - 1;
        double const solid = std::max(c.tiles - c.sky, 1.0);
        json const row = {{"scene", scene->name},
                          {"views", c.nanoseconds.size() / 3},
                          {"moving_bodies", bodies},
                          {"sky_tiles", c.sky / c.tiles},
                          {"one_plane_of_non_sky", c.one_plane / solid},
                          {"sky_or_two_planes", c.few_planes / c.tiles},
                          {"tiles_without_loose", c.no_loose / c.tiles},
                          {"loose_samples", c.loose / c.samples},
                          {"samples_with_velocity", c.flowing / c.samples},
                          {"mirror_samples", c.reflecting / c.samples},
                          {"layers_per_tile", c.layers / c.tiles},
                          {"farthest_pixels", c.farthest},
                          {"samples_off", c.off / c.samples},
                          {"samples_off_later", c.off_later / c.samples},
                          {"wire_bytes_per_sample", c.wire_bytes / c.samples},
                          {"fit_ns_per_sample", median(c.nanoseconds)}};
        auto const percent = [&](char const* key) { return 100 * row[key].get<double>(); };
        std::printf("%-18s %6zu %4.0f%% %7.1f%% %10.1f%% %8.1f%% %13.2f%% %8.1f%% %6.1f%% %7.2f %13.2f %5.2f%% %9.2f%% "
                    "%6.3f %10.2f\n",
                    scene->name.c_str(), bodies, percent("sky_tiles"), percent("one_plane_of_non_sky"),
                    percent("sky_or_two_planes"), percent("tiles_without_loose"), percent("loose_samples"),
                    percent("samples_with_velocity"), percent("mirror_samples"), c.layers / c.tiles, c.farthest,
                    percent("samples_off"), percent("samples_off_later"), row["wire_bytes_per_sample"].get<double>(),
                    row["fit_ns_per_sample"].get<double>());
        std::fflush(stdout);
        rows.push_back(row);
    }
    return rows;
}

} // namespace framelet::bench
