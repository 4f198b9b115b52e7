// Reads picture files, as a texture from memory and from a file, which EXR and HDR cannot be, and HDR as a sky. EXR as
// a sky is left out: OpenEXR takes memory for whatever an attribute in the header promises, and the sanitizer ends a
// program that is refused memory. Input: what is in the file. What it reads must not depend on what fresh memory holds.
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include <sanitizer/allocator_interface.h>
#include <tbb/global_control.h>

#include "common/error.h"
#include "common/files/image_io.h"
#include "common/files/picture_header.h"
#include "server/scene/reading/image_loading.h"
#include "tests/fuzz/input_file.h"

namespace {

using namespace framelet;

constexpr std::uint64_t memory_bytes = 8 << 20;

/// What fresh memory is full of. Libraries are not instrumented: what they read of it, or beyond what is theirs, shows.
std::uint8_t fresh = 0;

void fill_fresh(void const volatile* memory, std::size_t bytes) {
    constexpr std::size_t most = 1 << 16; // larger blocks calloc takes for empty
    if (bytes <= most) {
        std::memset(const_cast<void*>(memory), fresh, bytes);
    }
}

/// The picture; null where the file is none, or is too large.
std::shared_ptr<Picture const> read_texture(EncodedImage const& image, SceneFolder const& folder) {
    ImportBudget budget(memory_bytes);
    std::vector<std::string> warnings;
    try {
        auto const pictures =
            load_images(std::span(&image, 1), folder, budget, warnings, [](std::string_view, double) {});
        FRAMELET_CHECK(pictures.size() == 1 && warnings.size() == (pictures[0] ? 0 : 1));
        FRAMELET_CHECK(!pictures[0] || pictures[0]->rgba.size() <= memory_bytes);
        return pictures[0];
    } catch (SceneTooLarge const&) {
        return nullptr;
    }
}

void read_sky(std::filesystem::path const& file) {
    constexpr std::uint64_t bytes_per_pixel = 2 * sizeof(Vec3); // as the file has it, and as the image does
    ImportBudget budget(memory_bytes);
    try {
        FloatImage const image = read_float_image(file, [&](int width, int height) {
            budget.reserve(static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height), bytes_per_pixel);
        });
        for (Vec3 const& color : image.rgb) {
            for (int c = 0; c < 3; ++c) {
                FRAMELET_CHECK(std::isfinite(color[c]) && color[c] >= 0);
            }
        }
    } catch (InputError const&) {
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    static tbb::global_control const threads(tbb::global_control::max_allowed_parallelism, 1);
    static bool const fills = __sanitizer_install_malloc_and_free_hooks(fill_fresh, [](void const volatile*) {}) != 0;
    FRAMELET_CHECK(fills);
    std::span<std::byte const> const bytes = std::as_bytes(std::span(data, size));
    InputFile const file(data, size, ".picture");
    SceneFolder const folder(file.path(), false);
    fresh = 0x2e;
    auto const from_memory = read_texture({"picture", bytes, {}}, folder);
    fresh = 0xd1;
    auto const from_file = read_texture({"picture", {}, file.path()}, folder);
    // Of the file the bytes count as well: it may be the one that is too large.
    FRAMELET_CHECK(!from_file || (from_memory && *from_file == *from_memory));
    if (picture_format(bytes) == PictureFormat::hdr) {
        read_sky(file.path());
    }
    return 0;
}
