#include "server/scene/summary/scene_summary.h"

#include <algorithm>
#include <iomanip>
#include <sstream>

#include <nlohmann/json.hpp>

#include "common/counted.h"
#include "common/one_line.h"
#include "server/scene/backdrop.h"
#include "server/scene/finish/scene_memory.h"
#include "server/scene/motion/animation.h"
#include "server/scene/motion/bodies.h"
#include "server/scene/summary/visibility.h"

namespace framelet {
namespace {

using Json = nlohmann::ordered_json;

char const* kind_of(LightType type) {
    return type == LightType::directional ? "directional" : type == LightType::point ? "point" : "spot";
}

Json three(glm::dvec3 const& v) {
    return {v.x, v.y, v.z};
}

Json box_json(Scene const& scene, Bounds const& box) {
    return {{"low", three(scene.origin + glm::dvec3(box.lower))},
            {"high", three(scene.origin + glm::dvec3(box.upper))}};
}

/// A file may call things as it likes, with line breaks and what a terminal obeys too.
std::string shown(std::string const& name) {
    return name.empty() ? "(no name)" : to_one_line(name);
}

/// The one place that knows what is said; text and JSON have the same content.
Json summarize(Scene const& scene, std::span<Index const> clips) {
    SceneBodies const bodies = find_bodies(scene, clips);
    ScenePose const pose = evaluate_pose(scene, clips, 0);
    Json out = {{"scene", scene.name},
                {"nodes", scene.nodes.size()},
                {"meshes", scene.meshes.size()},
                {"triangles", count_triangles(scene)},
                {"materials", scene.materials.size()},
                {"textures", scene.textures.size()},
                {"images", scene.images.size()},
                {"image_bytes", image_bytes(scene)},
                {"memory_bytes", scene_bytes(scene) + bvh_bytes(scene) + scene.nodes.size() * bytes_a_node},
                {"bvh_bytes", bvh_bytes(scene)},
                {"bvh", scene.bvh == BvhKind::fast ? "fast" : "compact"},
                {"bounds", box_json(scene, scene_bounds(scene, pose))},
                {"bounds_without_backdrop", box_json(scene, without_backdrop(scene_parts(scene, pose)))},
                {"origin", three(scene.origin)},
                {"anything_to_see", has_anything_to_see(scene)},
                {"duration_seconds", animation_duration(scene, clips)}};
    Json& lights = out["lights"] = Json::array();
    for (Light const& light : scene.lights) {
        lights.push_back({{"name", light.name}, {"kind", kind_of(light.type)}});
    }
    Json& cameras = out["cameras"] = Json::array();
    std::vector<bool> const moving_ones = moving_cameras(scene, clips);
    for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
        cameras.push_back({{"name", scene.cameras[i].name}, {"moves", bool{moving_ones[i]}}});
    }
    Json& all_clips = out["clips"] = Json::array();
    for (std::size_t i = 0; i < scene.clips.size(); ++i) {
        all_clips.push_back({{"name", scene.clips[i].name},
                             {"seconds", scene.clips[i].duration},
                             {"plays", std::ranges::find(clips, static_cast<Index>(i)) != clips.end()}});
    }
    Json& moving = out["moving_bodies"] = Json::array();
    for (std::size_t body = 1; body < bodies.frames.size(); ++body) {
        moving.push_back(scene.nodes[static_cast<std::size_t>(bodies.frames[body])].name);
    }
    Json& flowing = out["deforming"] = Json::array();
    for (std::size_t n = 0; n < bodies.flows.size(); ++n) {
        if (bodies.flows[n]) {
            flowing.push_back(scene.nodes[n].name);
        }
    }
    out["passed_over"] = scene.warnings;
    return out;
}

class Lines {
public:
    Lines() { out_ << std::fixed; }

    /// The name stands beside the first entry only.
    void add(std::string const& name, std::vector<std::string> const& entries) {
        std::string left = name;
        for (std::string const& entry : entries) {
            out_ << "  " << std::left << std::setw(18) << left << entry << "\n";
            left.clear();
        }
    }
    /// Adds how many there are, then one to a line; of many only the first, since some scenes have ten thousand.
    void add(std::string const& name, std::string const& count, std::vector<std::string> const& entries) {
        constexpr std::size_t most = 20;
        add(name, {count});
        for (std::size_t i = 0; i < std::min(most, entries.size()); ++i) {
            add("", {"  " + entries[i]});
        }
        if (entries.size() > most) {
            add("", {"  and " + std::to_string(entries.size() - most) + " more"});
        }
    }
    std::string text() const { return out_.str(); }

private:
    std::ostringstream out_;
};

std::string fixed(double value, int digits) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(digits) << value;
    return out.str();
}

std::string count_of(Json const& number, std::string const& word, std::string const& plural = "") {
    return counted(number.get<std::size_t>(), word, plural);
}

template <typename Write>
std::vector<std::string> each(Json const& list, Write const& write) {
    std::vector<std::string> lines;
    for (Json const& entry : list) {
        lines.push_back(write(entry));
    }
    return lines;
}

std::string size_text(Json const& box) {
    std::string out;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        out += (axis == 0 ? "" : " x ") + fixed(box["high"][axis].get<double>() - box["low"][axis].get<double>(), 2);
    }
    return out + " m";
}

std::string name_of(Json const& entry) {
    return shown((entry.is_object() ? entry["name"] : entry).get<std::string>());
}

} // namespace

std::size_t count_triangles(Scene const& scene) {
    std::size_t count = 0;
    for (Node const& node : scene.nodes) {
        if (node.mesh != none) {
            count += count_triangles(scene.meshes[static_cast<std::size_t>(node.mesh)]);
        }
    }
    return count;
}

std::string scene_summary_text(Scene const& scene, std::span<Index const> clips) {
    Json const s = summarize(scene, clips);
    std::string size = size_text(s["bounds"]);
    if (s["bounds"] != s["bounds_without_backdrop"]) {
        size += ", without its backdrop " + size_text(s["bounds_without_backdrop"]);
    }
    Lines lines;
    lines.add("geometry", {count_of(s["triangles"], "triangle") + ", " + count_of(s["meshes"], "mesh", "meshes") +
                           ", " + count_of(s["nodes"], "node")});
    lines.add("size",
              {s["anything_to_see"].get<bool>() ? size : "there is nothing to see: a server refuses this scene"});
    if (scene.origin != glm::dvec3(0)) {
        glm::dvec3 const& at = scene.origin;
        lines.add("far away", {"about " + fixed(at.x, 0) + ", " + fixed(at.y, 0) + ", " + fixed(at.z, 0) +
                               " m: kept apart, so that nothing is less exact"});
    }
    lines.add("materials", {count_of(s["materials"], "material") + ", " + count_of(s["textures"], "texture") + " of " +
                            count_of(s["images"], "image") + " (" + fixed(s["image_bytes"].get<double>() * 1e-6, 1) +
                            " MB decoded)"});
    auto const megabytes = [&](char const* key) { return fixed(s[key].get<double>() * 1e-6, 1) + " MB"; };
    lines.add("memory", {megabytes("memory_bytes") + ", of it the " + s["bvh"].get<std::string>() + " BVH " +
                         megabytes("bvh_bytes")});
    lines.add(
        "lights", scene.lights.empty() ? "none: a sun and a sky are put in" : counted(s["lights"].size(), "light"),
        each(s["lights"], [](Json const& light) { return name_of(light) + ", " + light["kind"].get<std::string>(); }));
    lines.add(
        "cameras",
        scene.cameras.empty() ? "none: one that frames the scene is put in" : counted(s["cameras"].size(), "camera"),
        each(s["cameras"],
             [](Json const& camera) { return name_of(camera) + (camera["moves"].get<bool>() ? ", moves" : ""); }));
    lines.add("clips", scene.clips.empty() ? "none" : counted(s["clips"].size(), "clip"),
              each(s["clips"], [](Json const& clip) {
                  return name_of(clip) + ", " + fixed(clip["seconds"].get<double>(), 2) + " s" +
                         (clip["plays"].get<bool>() ? "" : ", does not play: --clip picks it");
              }));
    lines.add("moving bodies",
              s["moving_bodies"].empty() ? "none" : counted(s["moving_bodies"].size(), "body", "bodies"),
              each(s["moving_bodies"], name_of));
    if (!s["deforming"].empty()) {
        lines.add("deforming", counted(s["deforming"].size(), "node"), each(s["deforming"], name_of));
    }
    lines.add("passed over", scene.warnings.empty() ? "nothing" : counted(s["passed_over"].size(), "thing"),
              each(s["passed_over"], name_of));
    return shown(scene.name) + "\n" + lines.text();
}

std::string scene_summary_json(Scene const& scene, std::span<Index const> clips) {
    // Names are whatever bytes the file has.
    return summarize(scene, clips).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace framelet
