#include "client/window/kept/viewer_memory.h"

#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include "client/core/camera/camera_controller.h"
#include "client/core/client_core.h"
#include "client/window/kept/user_files.h"
#include "common/error.h"
#include "protocol/connection/server_address.h"
#include "protocol/stream/user_folders.h"

namespace framelet {

namespace {

using Json = nlohmann::ordered_json;

std::filesystem::path memory_file() {
    return state_folders().front() / "viewer.json";
}

bool flag(Json const& document, char const* name, bool otherwise) {
    auto const found = document.find(name);
    return found != document.end() && found->is_boolean() ? found->get<bool>() : otherwise;
}

double number(Json const& document, char const* name, double least, double most, double otherwise) {
    auto const found = document.find(name);
    double const value = found != document.end() && found->is_number() ? found->get<double>() : otherwise;
    return value >= least && value <= most ? value : otherwise;
}

std::optional<Viewport> size_of(Json const& value) {
    if (!value.is_array() || value.size() != 2 || !value[0].is_number_integer() || !value[1].is_number_integer()) {
        return std::nullopt;
    }
    // Smaller windows cannot be taken hold of any more.
    constexpr std::int64_t least = 100;
    auto const width = value[0].get<std::int64_t>();
    auto const height = value[1].get<std::int64_t>();
    if (width < least || height < least || width > max_viewport_side || height > max_viewport_side) {
        return std::nullopt;
    }
    return Viewport{static_cast<int>(width), static_cast<int>(height)};
}

std::string viewer_memory_text(ViewerMemory const& memory) {
    Json out;
    if (memory.size) {
        out["size"] = {memory.size->width, memory.size->height};
    }
    out["fullscreen"] = memory.fullscreen;
    out["statistics"] = memory.shows_statistics;
    out["details"] = memory.shows_details;
    out["bar"] = memory.shows_bar;
    out["servers"] = memory.servers;
    out["bias"] = memory.bias;
    out["smooth"] = memory.lag_seconds;
    out["fly_speed"] = memory.fly_speed;
    return out.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace

void ViewerMemory::note_server(std::string const& address) {
    std::erase(servers, address);
    servers.insert(servers.begin(), address);
    servers.resize(std::min(servers.size(), most_servers));
}

ViewerMemory parse_viewer_memory(std::string const& text) {
    ViewerMemory out;
    Json const document = Json::parse(text, nullptr, false);
    if (!document.is_object()) {
        return out;
    }
    out.size = size_of(document.value("size", Json()));
    out.fullscreen = flag(document, "fullscreen", out.fullscreen);
    out.shows_statistics = flag(document, "statistics", out.shows_statistics);
    out.shows_details = flag(document, "details", out.shows_details);
    out.shows_bar = flag(document, "bar", out.shows_bar);
    constexpr float most_speed = CameraController::most_speed_factor;
    out.bias = static_cast<float>(number(document, "bias", -1, 1, out.bias));
    out.lag_seconds = number(document, "smooth", 0, max_lag_seconds, out.lag_seconds);
    out.fly_speed = static_cast<float>(number(document, "fly_speed", 1 / most_speed, most_speed, out.fly_speed));
    Json const servers = document.value("servers", Json());
    for (Json const& server : servers.is_array() ? servers : Json::array()) {
        try {
            if (server.is_string() && out.servers.size() < ViewerMemory::most_servers) {
                auto const name = server.get<std::string>();
                out.servers.push_back(with_tls(parse_server_address(name).text(), asks_for_tls(name)));
            }
        } catch (InputError const&) { // left out
        }
    }
    return out;
}

ViewerMemory read_viewer_memory() {
    try {
        return parse_viewer_memory(read_user_file(memory_file()).value_or(""));
    } catch (InputError const&) {
        return {};
    }
}

void write_viewer_memory(ViewerMemory const& memory) {
    try {
        if (make_private_folder(memory_file().parent_path())) {
            write_user_file(memory_file(), viewer_memory_text(memory));
        }
    } catch (InputError const&) { // as the header says
    }
}

} // namespace framelet
