// Reads scene files. Input: one byte, the format; what is in the file. Formats whose memory only the system bounds are
// left out: the sanitizer ends a program that is refused memory.
#include <array>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

#include "common/error.h"
#include "server/scene/scene_import.h"

/// Assimp loses what it had made of an .obj that it then refuses; what our own code loses is still found.
extern "C" char const* __lsan_default_suppressions() {
    return "leak:libassimp";
}

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    using namespace framelet;
    if (size < 1) {
        return 0;
    }
    constexpr std::array formats{"gltf", "glb", "obj"};
    static std::string const stem =
        (std::filesystem::temp_directory_path() / ("framelet-fuzz-" + std::to_string(::getpid()) + ".")).string();
    std::string const file = stem + formats[data[0] % formats.size()];
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<char const*>(data + 1), static_cast<std::streamsize>(size - 1));
    ImportOptions options;
    options.memory_bytes = 64 << 20;
    try {
        import_scene(file, {}, options);
    } catch (InputError const&) {
    }
    std::filesystem::remove(file);
    return 0;
}
