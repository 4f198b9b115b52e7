#include "server/scene/assimp/assimp_log.h"

#include <algorithm>
#include <array>
#include <utility>

#include <assimp/DefaultLogger.hpp>
#include <assimp/LogStream.hpp>
#include <assimp/Logger.hpp>

namespace framelet {
namespace {

/// A scene may make it say the same of each of its parts.
constexpr std::size_t most_losses = 20;

std::mutex& log_mutex() {
    static std::mutex mutex;
    return mutex;
}

bool has(std::string_view text, std::string_view part) {
    auto const lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 32) : c; };
    return std::search(text.begin(), text.end(), part.begin(), part.end(),
                       [&](char a, char b) { return lower(a) == b; }) != text.end();
}

} // namespace

class AssimpLog::Stream : public Assimp::LogStream {
public:
    explicit Stream(std::set<std::string>& losses) : losses_(losses) {}

    void write(char const* line) override {
        std::string loss = loss_in(line);
        if (!loss.empty() && losses_.size() < most_losses) {
            losses_.insert(std::move(loss));
        }
    }

private:
    std::set<std::string>& losses_;
};

std::string loss_in(std::string_view line) {
    // "Warn,  T0: FBX: ignoring ..."
    for (std::string_view const before : {"Warn,", "Error,", "T0:"}) {
        std::size_t const at = line.find(before);
        line.remove_prefix(at > 12 ? 0 : at + before.size()); // also where there is none
    }
    std::size_t const first = line.find_first_not_of(" \n\r");
    line = first == line.npos ? std::string_view() : line.substr(first, line.find_last_not_of(" \n\r") + 1 - first);
    static std::array const plain{
        std::pair("nurbs", "NURBS surfaces and curves are not shown"),
        std::pair("metaball", "metaballs are not shown"),
        std::pair("spline", "splines are not shown"),
        std::pair("orthographic cameras", "cameras without perspective are passed over"),
        std::pair("uv channel", "some texture coordinates are passed over"),
        std::pair("coordinate sets", "some texture coordinates are passed over"),
        std::pair("uv-face", "some texture coordinates are passed over"),
        std::pair("color set", "some colours of vertices are passed over"),
        std::pair("animation", "some of its animation is passed over"),
        std::pair("track", "some of its animation is passed over"),
        std::pair("animator", "some of its animation is passed over"),
        std::pair("keyframe", "some of its animation is passed over"),
        std::pair("light", "some of its lights are passed over"),
        std::pair("normals", "some of its normals are passed over"),
        std::pair("texture", "some of its textures are passed over"),
        std::pair("opening", "some openings in walls are closed"),
        std::pair("vertex", "some of its polygons are passed over"),
        std::pair("face", "some of its polygons are passed over"),
        std::pair("polygon", "some of its polygons are passed over"),
        std::pair("mesh", "some of its meshes are passed over"),
        std::pair("geometry", "some of its meshes are passed over"),
    };
    static std::array const losses{"ignor", "skip", "not support", "unsupported", "not implemented", "not handled"};
    if (std::ranges::none_of(losses, [&](char const* word) { return has(line, word); })) {
        return {};
    }
    auto const known = std::ranges::find_if(plain, [&](auto const& entry) { return has(line, entry.first); });
    return known == plain.end() ? "" : known->second;
}

AssimpLog::AssimpLog() : lock_(log_mutex()) {
    Assimp::DefaultLogger::create("", Assimp::Logger::NORMAL, 0);
    Assimp::DefaultLogger::get()->attachStream(new Stream(losses_), // which the log owns
                                               Assimp::Logger::Warn | Assimp::Logger::Err);
}

AssimpLog::~AssimpLog() {
    Assimp::DefaultLogger::kill();
}

std::vector<std::string> AssimpLog::losses() const {
    return {losses_.begin(), losses_.end()};
}

} // namespace framelet
