#include "client/core/camera/camera_text.h"

#include <algorithm>
#include <iomanip>
#include <limits>
#include <locale>
#include <numbers>
#include <sstream>

#include <nlohmann/json.hpp>

namespace framelet {

namespace {

using Json = nlohmann::ordered_json;

constexpr double degrees = 180 / std::numbers::pi;

/// The number that is written with no more digits than it takes to read the same float again.
double shortest(float value) {
    double out = value;
    for (int digits = 6; digits <= std::numeric_limits<float>::max_digits10; ++digits) {
        std::stringstream text;
        text.imbue(std::locale::classic());
        text << std::setprecision(digits) << value;
        text >> out;
        if (static_cast<float>(out) == value) {
            break;
        }
    }
    return out;
}

Json vector_json(Vec3 const& v, glm::dvec3 const& from = glm::dvec3(0)) {
    return {from.x + shortest(v.x), from.y + shortest(v.y), from.z + shortest(v.z)};
}

/// The value of a hexadecimal digit; -1: it is none.
int digit_of(char c) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::size_t const at = digits.find(c >= 'A' && c <= 'F' ? static_cast<char>(c - 'A' + 'a') : c);
    return at == digits.npos ? -1 : static_cast<int>(at);
}

std::string percent_decoded(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        int const high = text[i] == '%' && i + 2 < text.size() ? digit_of(text[i + 1]) : -1;
        int const low = high >= 0 ? digit_of(text[i + 2]) : -1;
        out += low >= 0 ? static_cast<char>(high * 16 + low) : text[i];
        i += low >= 0 ? 2 : 0;
    }
    return out;
}

} // namespace

std::string camera_file_text(Camera const& camera, CameraMoment const& moment, glm::dvec3 const& origin) {
    Json out{{"position", vector_json(camera.position, origin)},
             {"target", vector_json(camera.position + camera.forward(), origin)},
             {"up", vector_json(camera.up())}};
    if (camera.projection == Projection::orthographic) {
        out["orthographic_height"] = shortest(camera.vertical_extent);
    } else {
        out["fov_degrees"] = shortest(static_cast<float>(camera.vertical_extent * degrees));
    }
    if (moment.scene_time) {
        out["scene_time"] = *moment.scene_time;
    }
    if (moment.paused) {
        out["paused"] = *moment.paused;
    }
    if (moment.exposure_ev) {
        out["exposure"] = shortest(*moment.exposure_ev);
    }
    return out.dump() + "\n";
}

std::optional<std::string> camera_in_address(std::string_view address) {
    constexpr std::string_view name = "camera=";
    std::size_t at = address.find('#');
    while (at < address.size()) {
        std::string_view const rest = address.substr(at + 1);
        std::size_t const length = std::min(rest.find('&'), rest.size());
        if (rest.starts_with(name)) {
            return percent_decoded(rest.substr(name.size(), length - name.size()));
        }
        at += 1 + length;
    }
    return std::nullopt;
}

} // namespace framelet
