// Reads camera files: what is taken is a camera at any time.
#include <string>

#include "client/core/camera/camera_path.h"
#include "common/error.h"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t size) {
    using namespace framelet;
    try {
        CameraPath const path = parse_camera_path({reinterpret_cast<char const*>(data), size}, "fuzzed");
        for (int i = -1; i <= 9 && path.scene_camera < 0; ++i) {
            FRAMELET_CHECK(is_valid(path.at(i / 8.0 * path.duration())));
        }
    } catch (InputError const&) {
    }
    return 0;
}
