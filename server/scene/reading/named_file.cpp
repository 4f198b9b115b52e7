#include "server/scene/reading/named_file.h"

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <memory>
#include <vector>

#include <utf8proc.h>

namespace framelet {
namespace {

namespace fs = std::filesystem;

/// The name without blanks and quotes around it, with the slashes of this system.
std::string plain(std::string_view name) {
    constexpr std::string_view around = " \t\r\n\"'";
    std::size_t const first = std::min(name.find_first_not_of(around), name.size());
    std::string text(name.substr(first, name.find_last_not_of(around) + 1 - first));
    std::replace(text.begin(), text.end(), '\\', '/');
    return text;
}

/// The text in which names are the same that differ in case and composition alone.
std::string folded(std::string const& name) {
    utf8proc_uint8_t* out = nullptr;
    constexpr auto how = static_cast<utf8proc_option_t>(UTF8PROC_STABLE | UTF8PROC_COMPOSE | UTF8PROC_CASEFOLD);
    utf8proc_ssize_t const length = utf8proc_map(reinterpret_cast<utf8proc_uint8_t const*>(name.data()),
                                                 static_cast<utf8proc_ssize_t>(name.size()), &out, how);
    std::unique_ptr<utf8proc_uint8_t, decltype(&std::free)> const owner(out, std::free);
    return length < 0 ? name : std::string(reinterpret_cast<char const*>(out), static_cast<std::size_t>(length));
}

bool is_file(SceneFolder const& folder, fs::path const& file) {
    std::error_code code;
    return folder.permits(file) && fs::is_regular_file(file, code);
}

/// The file at the path below the folder, whatever the case of its parts; empty where there is none.
fs::path find_folded(SceneFolder const& folder, fs::path const& path) {
    fs::path at = folder.path();
    if (path.is_absolute()) {
        return {};
    }
    for (fs::path const& part : path) {
        std::string const wanted = folded(part.string());
        fs::path found;
        std::error_code code;
        for (fs::directory_iterator entry(at, code), end; !code && entry != end; entry.increment(code)) {
            fs::path const name = entry->path().filename();
            if (folded(name.string()) == wanted && (found.empty() || name < found)) {
                found = name;
            }
        }
        if (found.empty() || !folder.permits(at / found)) {
            return {};
        }
        at /= found;
    }
    return is_file(folder, at) ? at : fs::path();
}

/// The path and what is left of it without its first parts, the longest first; of a deep one the shortest.
std::vector<fs::path> endings_of(fs::path const& path) {
    constexpr std::ptrdiff_t deepest = 16;
    std::vector<fs::path> out;
    std::ptrdiff_t const deep = std::distance(path.begin(), path.end());
    for (auto first = std::next(path.begin(), std::max(deep - deepest, std::ptrdiff_t(0))); first != path.end();
         ++first) {
        fs::path ending;
        for (auto part = first; part != path.end(); ++part) {
            ending /= *part;
        }
        if (first == path.begin() || (ending.is_relative() && *ending.begin() != "..")) {
            out.push_back(std::move(ending));
        }
    }
    return out;
}

} // namespace

NamedFile find_named_file(SceneFolder const& folder, char const* kind, std::string_view name) {
    fs::path const as_named = folder.path() / fs::path(name);
    if (is_file(folder, as_named)) {
        return {as_named, {}};
    }
    std::vector<fs::path> const endings = endings_of(fs::path(plain(name)).lexically_normal());
    NamedFile out;
    for (fs::path const& ending : endings) {
        if (out.file.empty() && is_file(folder, folder.path() / ending)) {
            out.file = folder.path() / ending;
        }
    }
    for (fs::path const& ending : endings) {
        out.file = out.file.empty() ? find_folded(folder, ending) : out.file;
    }
    if (!out.file.empty()) {
        out.remark = std::string(kind) + " '" + std::string(name) + "' is not there; '" +
                     out.file.lexically_relative(folder.path()).string() + "' is taken";
    }
    return out;
}

std::string no_named_file(SceneFolder const& folder, char const* kind, std::string_view name) {
    std::string const wanted = plain(name);
    return folder.permits(folder.path() / wanted) ? std::string(kind) + " '" + wanted + "' is missing"
                                                  : SceneFolder::refusal(kind, wanted);
}

} // namespace framelet
