// Reads scene files. Input: one byte, the format; what is in the file. The formats are those that are read here. What
// Assimp reads is left out: only the system bounds its memory, and the sanitizer ends a program that is refused some.
#include <array>
#include <string>

#include "common/error.h"
#include "server/scene/scene_import.h"
#include "tests/fuzz/input_file.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    using namespace framelet;
    if (size < 1) {
        return 0;
    }
    constexpr std::array endings{".gltf", ".glb", ".obj", ".stl", ".ply"};
    InputFile const file(data + 1, size - 1, endings[data[0] % endings.size()]);
    ImportOptions options;
    options.memory_bytes = 64 << 20;
    try {
        import_scene(file.path(), {}, options);
    } catch (InputError const&) {
    }
    return 0;
}
