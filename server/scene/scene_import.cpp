#include "server/scene/scene_import.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

#include "common/error.h"
#include "common/one_line.h"
#include "server/scene/assimp/assimp_import.h"
#include "server/scene/finish/scene_finish.h"
#include "server/scene/finish/scene_memory.h"
#include "server/scene/finish/scene_origin.h"
#include "server/scene/gltf/gltf_import.h"
#include "server/scene/mesh/mesh_import.h"
#include "server/scene/reading/file_ending.h"
#include "server/scene/reading/import_budget.h"
#include "server/scene/reading/import_check.h"
#include "server/scene/reading/scene_folder.h"
#include "server/scene/scene_axes.h"
#include "server/scene/scene_merge.h"

namespace framelet {
namespace {

/// The text as one printable line of bounded length, whatever the file's names and a library's message hold.
std::string one_line(std::string text) {
    constexpr std::size_t longest = 400;
    text.erase(text.find_last_not_of(" \n\r\t") + 1);
    std::string const line = to_one_line(text);
    return line.size() > longest ? to_one_line(line, longest) + "..." : line;
}

/// True for formats without trees.
bool is_flat(std::string const& extension) {
    return is_mesh_file(extension) || extension == ".off";
}

void check_file(std::filesystem::path const& file) {
    std::error_code code;
    if (!std::filesystem::exists(file, code)) {
        throw InputError("there is no such file");
    }
    if (std::filesystem::is_directory(file, code)) {
        throw InputError("it is a folder; framelet-server with a folder alone lists the scenes in it");
    }
    if (!std::filesystem::is_regular_file(file, code)) {
        throw InputError("it is not a file");
    }
    std::uintmax_t const size = std::filesystem::file_size(file, code);
    if (code || size == 0) {
        throw InputError(code ? "it cannot be read" : "the file is empty");
    }
}

/// Says how exact positions are that were single numbers so far away.
std::string coarseness(glm::dvec3 const& origin) {
    double const away = std::max({std::abs(origin.x), std::abs(origin.y), std::abs(origin.z)});
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(),
                  "it lies %.0f km from its origin: positions of this format are exact to %.2g mm", away / 1000,
                  std::exp2(std::floor(std::log2(away)) - 23) * 1000);
    return text.data();
}

/// Every warning once, on one line; of very many the first, and how many more there are.
std::vector<std::string> condensed(std::vector<std::string> const& warnings) {
    constexpr std::size_t most = 100;
    std::vector<std::string> lines;
    std::set<std::string> seen;
    for (std::string const& warning : warnings) {
        if (seen.insert(warning).second && seen.size() <= most) {
            lines.push_back(one_line(warning));
        }
    }
    if (seen.size() > most) {
        lines.push_back(std::to_string(seen.size() - most) + " more warnings");
    }
    return lines;
}

Scene import_file(std::filesystem::path const& file, Progress const& report, ImportOptions const& options,
                  ImportBudget& budget) {
    try {
        check_file(file);
        std::string const extension = lower_extension(file);
        SceneFolder const folder(file, options.allow_outside);
        bool const is_gltf = extension == ".gltf" || extension == ".glb";
        if (!options.checker.empty() && (options.is_serving || !(is_gltf || is_flat(extension)))) {
            ImportOptions of_file = options;
            of_file.memory_bytes = budget.left();
            check_import(file, of_file, report);
        }
        if (!is_gltf && !options.scene.empty()) {
            throw InputError("--scene is for glTF; a file of another format has one scene");
        }
        Scene scene = is_gltf
                          ? import_gltf(file, folder, budget, options.scene, options.clips, options.is_serving, report)
                      : is_mesh_file(extension) ? import_mesh(file, folder, budget, report)
                                                : import_assimp(file, folder, budget, report, options.is_serving);
        if (options.is_serving && scene.is_truncated) { // what is being written is read again when it has changed
            throw InputError("the file is truncated, or not all written yet");
        }
        if (extension == ".stl" && options.up == "y" && options.unit == "m") {
            scene.warnings.emplace_back(
                "an STL file says neither what its unit is nor which axis is up: taken as metres, "
                "with y up; --unit and --up say otherwise");
        }
        orient_scene(scene, parse_up_axis(options.up), parse_unit(options.unit));
        finish_scene(scene, budget, report);
        if (!is_gltf && !is_mesh_file(extension) && scene.origin != glm::dvec3(0)) {
            scene.warnings.push_back(coarseness(scene.origin));
        }
        scene.name = one_line(scene.name.empty() ? file.stem().string() : scene.name);
        for (AnimationClip& clip : scene.clips) {
            clip.name = one_line(clip.name);
        }
        scene.warnings = condensed(scene.warnings);
        scene.files = folder.asked_for();
        scene.files.insert(scene.files.begin(), std::filesystem::absolute(file));
        return scene;
    } catch (InputError const& error) {
        throw InputError(one_line("cannot load scene '" + file.string() + "': " + error.what()));
    } catch (std::bad_alloc const&) {
        throw InputError("cannot load scene '" + file.string() + "': it does not fit in memory");
    }
}

} // namespace

Scene import_scene(std::filesystem::path const& file, Progress const& progress, ImportOptions const& options) {
    return import_scenes(std::span(&file, 1), progress, options);
}

Scene import_scenes(std::span<std::filesystem::path const> files, Progress const& progress,
                    ImportOptions const& options) {
    FRAMELET_CHECK(!files.empty());
    Progress const report = progress ? progress : [](std::string_view, double) {};
    ImportBudget budget(options.memory_bytes);
    if (files.size() == 1) {
        Scene scene = import_file(files.front(), report, options, budget);
        scene.bvh = bvh_within(scene, options.memory_bytes);
        return scene;
    }
    ImportOptions of_each = options;
    of_each.clips.clear(); // each may be in any of them
    std::vector<Scene> scenes;
    for (std::filesystem::path const& file : files) {
        std::string const name = " (" + file.filename().string() + ")";
        scenes.push_back(import_file(
            file, [&](std::string_view what, double fraction) { report(std::string(what) + name, fraction); }, of_each,
            budget));
    }
    Scene out = merged_scene(std::move(scenes), words_for(files));
    set_origin(out);
    out.warnings = condensed(out.warnings);
    out.bvh = bvh_within(out, options.memory_bytes);
    return out;
}

} // namespace framelet
