#include "client/window/kept/user_files.h"

#include <array>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iomanip>
#include <sstream>

#include <unistd.h>

#include "common/error.h"
#include "common/files/regular_file.h"

namespace framelet {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_bytes = 1 << 20;
constexpr std::size_t longest_stem = 100;

fs::path path_variable(char const* name) {
    char const* const value = std::getenv(name);
    fs::path const path = value == nullptr ? "" : value;
    return path.is_absolute() ? path : fs::path();
}

/// A file's name for something with this name: never one of another folder, never a hidden one, never too long.
std::string file_stem_for(std::string const& name) {
    std::string out;
    for (char const c : name.substr(0, longest_stem)) {
        auto const byte = static_cast<unsigned char>(c);
        bool const is_plain = byte >= 0x80 || std::isalnum(byte) != 0 || c == '-' || c == '_' || c == ' ' || c == '.';
        out += is_plain ? c : '_';
    }
    if (out.empty() || out.front() == '.') {
        out.insert(0, "_");
    }
    return out;
}

} // namespace

fs::path config_folder() {
    if (fs::path const config = path_variable("XDG_CONFIG_HOME"); !config.empty()) {
        return config / "framelet";
    }
    fs::path const home = path_variable("HOME");
    return home.empty() ? fs::path() : home / ".config" / "framelet";
}

std::optional<std::string> read_user_file(fs::path const& file) {
    std::error_code error;
    if (file.empty() || fs::status(file, error).type() == fs::file_type::not_found) {
        return std::nullopt;
    }
    RegularFile const opened(file);
    std::ifstream in(opened.name(), std::ios::binary);
    std::string text(most_bytes + 1, '\0');
    in.read(text.data(), static_cast<std::streamsize>(text.size()));
    text.resize(static_cast<std::size_t>(in.gcount()));
    if (!in.eof() || text.size() > most_bytes) {
        throw InputError("cannot read " + file.string());
    }
    return text;
}

void write_user_file(fs::path const& file, std::string const& text) {
    if (file.empty()) {
        throw InputError("there is no folder to keep this in: set HOME");
    }
    std::error_code error;
    fs::create_directories(file.parent_path(), error); // where that fails so does what follows
    fs::path temporary = file;
    temporary += ".new-" + std::to_string(::getpid());
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    out.close();
    if (out) {
        fs::rename(temporary, file, error);
        if (!error) {
            return;
        }
    }
    std::error_code ignored;
    fs::remove(temporary, ignored);
    throw InputError("cannot write " + file.string() + (error ? ": " + error.message() : ""));
}

std::string file_stem_of_scene(std::string const& scene_name, std::uint64_t scene_source) {
    std::array<char, 24> place{};
    if (scene_source != 0) {
        std::snprintf(place.data(), place.size(), "-%016llx", static_cast<unsigned long long>(scene_source));
    }
    return file_stem_for(scene_name) + place.data();
}

fs::path new_file_name(fs::path const& folder, std::string const& extension) {
    std::time_t const now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    std::ostringstream stem;
    stem << "framelet-" << std::put_time(&local, "%Y%m%d-%H%M%S");
    fs::path out = folder / (stem.str() + extension);
    std::error_code error;
    for (int number = 2; fs::exists(out, error); ++number) {
        out = folder / (stem.str() + "-" + std::to_string(number) + extension);
    }
    return out;
}

} // namespace framelet
