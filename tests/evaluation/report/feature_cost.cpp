#include "tests/evaluation/report/feature_cost.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <string>

#include <nlohmann/json.hpp>
#include <tbb/global_control.h>

#include "protocol/messages/message.h"
#include "protocol/messages/message_codec.h"
#include "server/scene/motion/animation.h"
#include "server/scene/scene_import.h"
#include "server/stream/framelet_stream.h"
#include "server/stream/posed_scene.h"
#include "tests/evaluation/stopwatch.h"

namespace framelet::bench {
namespace {

using nlohmann::json;

constexpr double samples_per_pixel_and_second = 5;

/// Features of a scene, in the order in which they are put in.
struct Features {
    bool motion = false, mirrors = false, deformation = false, cut_outs = false;
};

void make_matt(Scene& scene) {
    for (Material& material : scene.materials) {
        material.metallic = 0;
        material.roughness = 1;
        material.metallic_roughness_texture = {};
    }
}

/// Makes every mesh that an animated node carries swell and shrink once a second.
void deform(Scene& scene) {
    if (scene.clips.empty()) {
        return;
    }
    AnimationClip& clip = scene.clips.front();
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        auto const node = static_cast<Index>(i);
        bool const moves = std::ranges::any_of(
            clip.channels, [&](auto const& c) { return c.node == node || c.node == scene.nodes[i].parent; });
        if (scene.nodes[i].mesh == none || !moves) {
            continue;
        }
        Mesh mesh = scene.meshes[static_cast<std::size_t>(scene.nodes[i].mesh)];
        mesh.morph_weights = {0};
        for (Primitive& primitive : mesh.primitives) {
            MorphTarget target{primitive.normals, {}, {}};
            std::ranges::for_each(target.positions, [](Vec3& offset) { offset *= 0.03f; });
            primitive.morph_targets = {target};
        }
        scene.nodes[i].mesh = static_cast<Index>(scene.meshes.size());
        scene.meshes.push_back(std::move(mesh));
        AnimationChannel channel{node, AnimatedProperty::morph_weights, Interpolation::linear, 1, {}, {}};
        for (float time = 0; time <= clip.duration; time += 0.5f) {
            channel.times.push_back(time);
            channel.values.push_back(static_cast<float>(channel.values.size() % 2));
        }
        clip.channels.push_back(std::move(channel));
    }
}

/// Turns a quarter of every texture into holes, each a sixteenth of its width.
void cut_out(Scene& scene) {
    for (auto& image : scene.images) {
        auto holed = std::make_shared<Picture>(*image);
        int const side = std::max(1, holed->width / 16);
        for (int y = 0; y < holed->height; ++y) {
            for (int x = 0; x < holed->width; ++x) {
                holed->row(y)[4 * x + 3] = x / side % 2 == 0 && y / side % 2 == 0 ? 0 : 255;
            }
        }
        image = std::move(holed);
    }
    for (Material& material : scene.materials) {
        if (material.base_color_texture.texture != none && !material.unlit) {
            material.alpha_mode = AlphaMode::mask;
            material.double_sided = true;
        }
    }
}

Scene with(Scene scene, Features const& features) {
    if (!features.motion) {
        scene.clips.clear();
    }
    if (!features.mirrors) {
        make_matt(scene);
    }
    if (features.deformation) {
        deform(scene);
    }
    if (features.cut_outs) {
        cut_out(scene);
    }
    return scene;
}

/// Costs of a session that is never held up, summed over all turns.
struct Cost {
    double render = 0, other = 0; ///< seconds of one thread
    double response = 0; ///< part of `other`: planning by the mirror, learning without the fitting of shapes
    double samples = 0, segments = 0, bytes = 0;

    json to_json(char const* what) const {
        return {{"what", what},
                {"render_ns", 1e9 * render / samples},
                {"other_ns", 1e9 * other / samples},
                {"response_share", response / (render + other)},
                {"rays", segments / samples},
                {"bytes", bytes / samples}};
    }
};

/// Serves the scene for `seconds`. `shape_sample`: cost of fitting shapes, nanoseconds a sample, which is a part of
/// learning.
Cost serve(Scene const& scene, Viewport viewport, double seconds, double shape_sample) {
    tbb::global_control const one_thread(tbb::global_control::max_allowed_parallelism, 1);
    std::vector<Index> const clips = default_clips(scene);
    RenderScene render_scene(scene, std::nullopt);
    PosedScene posed(scene, clips, render_scene);
    Camera const camera = posed.camera(0, 0);
    StreamOptions options;
    options.exposure = auto_exposure(render_scene, camera);
    FrameletStream stream(options, coding::all);
    double const rate = samples_per_pixel_and_second * viewport.width * viewport.height;
    stream.take({0, ViewerSettings{0, 0, true}});
    stream.take({0, CameraUpdate{{1, camera, viewport}, 0}});
    Cost cost;
    std::uint64_t answered = 0;
    for (double now = 0; now < seconds;) {
        Step step = Step::nothing;
        double const planned = processor_seconds_of([&] { step = stream.plan({now, now, 1, rate, 0}, posed); });
        cost.other += planned;
        cost.response += planned;
        if (step != Step::render) {
            now += 0.002;
            continue;
        }
        posed.pose(stream.moment());
        cost.render += processor_seconds_of([&] { stream.render(posed); });
        bool sends = false;
        double const learnt = processor_seconds_of([&] { sends = stream.learn(posed); });
        TurnFigures const& figures = stream.learnt_figures();
        double const shaped = 1e-9 * shape_sample * static_cast<double>(figures.shaped_samples);
        cost.other += learnt;
        cost.response += std::max(0.0, learnt - shaped);
        cost.samples += static_cast<double>(figures.rays);
        cost.segments += static_cast<double>(figures.segments);
        now += static_cast<double>(figures.rays) / rate;
        if (sends) {
            EncodedBatch batch;
            cost.other += processor_seconds_of([&] { batch = stream.encode(); });
            auto const bytes = encode_message(batch).size();
            cost.bytes += static_cast<double>(bytes);
            stream.take({now, BatchSent{stream.last_batch(), bytes}});
            stream.take({now, Ack{++answered, static_cast<std::uint64_t>(1e6 * now), 0}});
        }
    }
    return cost;
}

} // namespace

json measure_feature_costs(std::filesystem::path const& scene_file, Viewport viewport, double seconds,
                           CostTable const& costs) {
    Scene const whole = import_scene(scene_file);
    Features features;
    json rows = json::array();
    auto const add = [&](char const* what) {
        rows.push_back(serve(with(whole, features), viewport, seconds, costs.shape_sample).to_json(what));
    };
    add("nothing moves, all matt and whole");
    features.motion = true;
    add("+ bodies and camera move");
    features.mirrors = true;
    add("+ mirrors");
    features.deformation = true;
    add("+ what moves is bent as well");
    features.cut_outs = true;
    add("+ cut-outs");
    return rows;
}

} // namespace framelet::bench
