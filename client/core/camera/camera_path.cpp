#include "client/core/camera/camera_path.h"

#include <algorithm>
#include <fstream>
#include <initializer_list>
#include <numbers>

#include <glm/geometric.hpp>
#include <nlohmann/json.hpp>

#include "client/core/camera/camera_text.h"
#include "common/error.h"
#include "common/files/regular_file.h"

namespace framelet {

namespace {

using Json = nlohmann::json;

constexpr double largest_coordinate = 1e9; ///< metres
constexpr std::size_t most_bytes = 16u << 20;
constexpr std::size_t most_keys = 100000;

/// Reads fields; its errors name the file and what is wrong with which field.
struct Reader {
    std::string name;

    [[noreturn]] void fail(std::string const& what) const { throw InputError("camera file " + name + ": " + what); }

    double number(Json const& value, std::string const& field, double low, double high) const {
        if (!value.is_number()) {
            fail("\"" + field + "\" must be a number");
        }
        double const out = value.get<double>();
        if (!(out >= low && out <= high)) {
            fail("\"" + field + "\" is out of range");
        }
        return out;
    }

    glm::dvec3 vector(Json const& value, std::string const& field) const {
        if (!value.is_array() || value.size() != 3) {
            fail("\"" + field + "\" must be an array of three numbers");
        }
        glm::dvec3 out;
        for (int i = 0; i < 3; ++i) {
            out[i] = number(value[static_cast<std::size_t>(i)], field, -largest_coordinate, largest_coordinate);
        }
        return out;
    }

    void only_fields(Json const& object, std::initializer_list<char const*> known) const {
        if (!object.is_object()) {
            fail("there must be an object with \"position\" and \"target\", \"keys\" or \"scene_camera\"");
        }
        for (auto const& [field, value] : object.items()) {
            if (std::find(known.begin(), known.end(), field) == known.end()) {
                fail("unknown field \"" + field + "\"");
            }
        }
    }

    Json const& required(Json const& object, char const* field) const {
        if (!object.contains(field)) {
            fail(std::string("\"") + field + "\" is missing");
        }
        return object[field];
    }

    CameraKey key(Json const& object) const {
        only_fields(object, {"time", "position", "target", "up", "fov_degrees", "orthographic_height"});
        CameraKey out;
        out.position = vector(required(object, "position"), "position");
        out.target = vector(required(object, "target"), "target");
        if (object.contains("up")) {
            out.up = vector(object["up"], "up");
        }
        if (object.contains("fov_degrees")) {
            out.vertical_fov =
                static_cast<float>(number(object["fov_degrees"], "fov_degrees", 0.1, 175) * std::numbers::pi / 180);
        }
        if (object.contains("orthographic_height")) {
            if (object.contains("fov_degrees")) {
                fail("there is \"fov_degrees\" or \"orthographic_height\", not both");
            }
            out.orthographic_height = static_cast<float>(number(object["orthographic_height"], "orthographic_height",
                                                                double{least_view_height}, double{most_view_height}));
        }
        if (object.contains("time")) {
            out.time = number(object["time"], "time", 0, 1e6);
        }
        if (!(glm::distance(out.position, out.target) > 0)) {
            fail("\"position\" and \"target\" are the same point");
        }
        if (!(glm::length(out.up) > 0)) {
            fail("\"up\" has no direction");
        }
        out.up = glm::normalize(out.up);
        return out;
    }
};

/// Takes the moment out of a document.
CameraMoment take_moment(Reader const& reader, Json& document) {
    CameraMoment out;
    if (document.contains("scene_time")) {
        out.scene_time = reader.number(document["scene_time"], "scene_time", 0, max_scene_time);
    }
    if (document.contains("paused")) {
        if (!document["paused"].is_boolean()) {
            reader.fail("\"paused\" must be true or false");
        }
        out.paused = document["paused"].get<bool>();
    }
    if (document.contains("exposure")) {
        out.exposure_ev = static_cast<float>(reader.number(document["exposure"], "exposure", -16, 16));
    }
    for (char const* const field : {"scene_time", "paused", "exposure"}) {
        document.erase(field);
    }
    return out;
}

Vec3 position_of(CameraKey const& key, glm::dvec3 const& origin) {
    return Vec3(key.position - origin);
}

Vec3 target_of(CameraKey const& key, glm::dvec3 const& origin) {
    return Vec3(key.target - origin);
}

Camera camera_of(CameraKey const& key, glm::dvec3 const& origin) {
    Camera out = look_at(position_of(key, origin), target_of(key, origin), key.up, key.vertical_fov);
    if (key.orthographic_height > 0) {
        out.projection = Projection::orthographic;
        out.vertical_extent = key.orthographic_height;
    }
    return out;
}

/// Cubic Hermite piece from a to b, `t` in [0, 1], tangents for the piece's whole length.
template <typename T>
T hermite(T const& a, T const& b, T const& tangent_a, T const& tangent_b, float t) {
    float const t2 = t * t;
    float const t3 = t2 * t;
    return a * (2 * t3 - 3 * t2 + 1) + tangent_a * (t3 - 2 * t2 + t) + b * (3 * t2 - 2 * t3) + tangent_b * (t3 - t2);
}

} // namespace

ClockRequest CameraMoment::clock_request() const {
    ClockRequest out;
    if (scene_time) {
        out.set |= ClockRequest::time;
        out.state.time = *scene_time;
    }
    if (paused) {
        out.set |= ClockRequest::playing;
        out.state.playing = !*paused;
    }
    return out;
}

Camera CameraPath::at(double seconds, glm::dvec3 const& origin) const {
    FRAMELET_CHECK(!keys.empty());
    auto const after =
        std::upper_bound(keys.begin(), keys.end(), seconds, [](double t, CameraKey const& k) { return t < k.time; });
    if (after == keys.begin() || after == keys.end()) {
        return camera_of(after == keys.begin() ? keys.front() : keys.back(), origin);
    }
    CameraKey const& a = *(after - 1);
    CameraKey const& b = *after;
    CameraKey const& before_a = after - 1 == keys.begin() ? a : *(after - 2);
    CameraKey const& after_b = after + 1 == keys.end() ? b : *(after + 1);
    double const length = b.time - a.time;
    auto const t = static_cast<float>((seconds - a.time) / length);
    auto const piece = [&](auto const& value_of) {
        auto const from = value_of(a), to = value_of(b), before = value_of(before_a), after_it = value_of(after_b);
        if (from == to) {
            return from; // equal to the last bit, so that a picture of what stands still can be completed
        }
        bool const rests_before = &before_a != &a && before == from;
        bool const rests_after = &after_b != &b && after_it == to;
        float const share_a = rests_before ? 0.0f : static_cast<float>(length / (b.time - before_a.time));
        float const share_b = rests_after ? 0.0f : static_cast<float>(length / (after_b.time - a.time));
        return hermite(from, to, (to - before) * share_a, (after_it - from) * share_b, t);
    };
    Vec3 const position = piece([&](CameraKey const& key) { return position_of(key, origin); });
    Vec3 target = piece([&](CameraKey const& key) { return target_of(key, origin); });
    Vec3 const ahead(a.target - a.position);
    if (!(glm::distance(position, target) > 1e-6f * glm::length(ahead))) {
        target = position + ahead; // the two curves cross here: keep looking as before
    }
    Vec3 up = piece([](CameraKey const& key) { return key.up; });
    if (!(glm::length(up) > 1e-3f)) {
        up = a.up;
    }
    float const fov = std::clamp(piece([](CameraKey const& key) { return key.vertical_fov; }), 0.0017f, 3.1f);
    return look_at(position, target, up, fov);
}

CameraPath parse_camera_path(std::string const& json, std::string const& name) {
    Reader const reader{name};
    Json document;
    try {
        document = Json::parse(json);
    } catch (Json::parse_error const& error) {
        reader.fail("not JSON: byte " + std::to_string(error.byte));
    } catch (Json::out_of_range const&) {
        reader.fail("a number in it is out of range");
    }
    CameraPath out;
    if (document.is_object()) {
        out.moment = take_moment(reader, document);
    }
    if (document.is_object() && document.contains("scene_camera")) {
        reader.only_fields(document, {"scene_camera"});
        Json const& number = document["scene_camera"];
        if (!number.is_number_integer()) {
            reader.fail("\"scene_camera\" must be a whole number");
        }
        out.scene_camera = static_cast<int>(reader.number(number, "scene_camera", 0, 1e6));
        return out;
    }
    if (!document.is_object() || !document.contains("keys")) {
        out.keys.push_back(reader.key(document));
        out.keys.front().time = 0;
        return out;
    }
    reader.only_fields(document, {"keys"});
    Json const& keys = document["keys"];
    if (!keys.is_array() || keys.empty() || keys.size() > most_keys) {
        reader.fail("\"keys\" must be an array of 1 to " + std::to_string(most_keys) + " keys");
    }
    for (Json const& key : keys) {
        if (key.is_object()) {
            reader.required(key, "time");
        }
        out.keys.push_back(reader.key(key));
        if (out.keys.back().orthographic_height > 0) {
            reader.fail("\"orthographic_height\" is for a camera that stands still");
        }
        if (out.keys.size() > 1 && !(out.keys.back().time > (out.keys.end() - 2)->time)) {
            reader.fail("the times of the keys must grow");
        }
    }
    return out;
}

CameraPath read_camera_path(std::filesystem::path const& file) {
    if (auto const text = camera_in_address(file.native())) {
        return parse_camera_path(*text, "of the address");
    }
    RegularFile const opened(file);
    std::ifstream in(opened.name(), std::ios::binary);
    std::string text;
    if (in) {
        text.resize(most_bytes + 1);
        in.read(text.data(), static_cast<std::streamsize>(text.size()));
        text.resize(static_cast<std::size_t>(in.gcount()));
    }
    if (!in.eof() || text.size() > most_bytes) {
        throw InputError("camera file " + file.string() + ": cannot be read" + (opened ? "" : ": " + opened.problem()));
    }
    return parse_camera_path(text, file.string());
}

} // namespace framelet
