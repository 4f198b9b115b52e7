#include "client/window/kept/scene_memory.h"

#include <cmath>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "client/window/kept/user_files.h"
#include "common/error.h"
#include "protocol/stream/user_folders.h"

namespace framelet {

namespace {

using Json = nlohmann::ordered_json;

std::filesystem::path file_of(std::string const& scene_name, std::uint64_t scene_source) {
    return state_folders().front() / "scenes" / (file_stem_of_scene(scene_name, scene_source) + ".json");
}

} // namespace

SceneMemory read_scene_memory(std::string const& scene_name, std::uint64_t scene_source) {
    SceneMemory out;
    try {
        Json const document =
            Json::parse(read_user_file(file_of(scene_name, scene_source)).value_or(""), nullptr, false);
        Json const exposure = document.is_object() ? document.value("exposure", Json()) : Json();
        if (exposure.is_number() && std::abs(exposure.get<double>()) <= static_cast<double>(largest_exposure)) {
            out.exposure_ev = exposure.get<float>();
        }
    } catch (InputError const&) { // as the header says
    }
    return out;
}

void write_scene_memory(std::string const& scene_name, std::uint64_t scene_source, SceneMemory const& memory) {
    try {
        std::filesystem::path const file = file_of(scene_name, scene_source);
        if (make_private_folder(file.parent_path())) {
            write_user_file(file, Json{{"exposure", memory.exposure_ev}}.dump(2) + "\n");
        }
    } catch (InputError const&) { // as the header says
    }
}

} // namespace framelet
