// The reference: pictures that a perfect viewer would show, many samples a pixel (stratified, box filter), kept on disk
// as PNG files, since rendering takes long. In: scene, size, times. Out: a picture for each time.
#pragma once

#include <filesystem>

#include "common/image.h"
#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/scene_events.h"

namespace framelet::bench {

struct ReferenceParameters {
    Viewport viewport{256, 256};
    double seconds = 1;
    double rate = 120; ///< pictures a second
    int samples_per_side = 3; ///< samples along a side of a pixel, jittered in their strata
    double start = 0; ///< scene time of the first picture, seconds
    std::vector<ClockSetting> clock_settings{}; ///< as in RunParameters; the scene's name has to tell of them
};

class Reference {
public:
    /// Renders what the cache lacks and tells on stderr how far it is. Compares two cached pictures with ones rendered
    /// anew, and makes all again where the renderer has changed.
    Reference(BenchScene& scene, ReferenceParameters const& parameters, std::filesystem::path const& cache);

    std::size_t size() const { return count_; }
    /// Reads a picture from its file. Throws InputError where that has gone since.
    Picture picture(std::size_t index) const;
    std::filesystem::path const& folder() const { return folder_; }

private:
    std::filesystem::path file(std::size_t index) const;

    std::filesystem::path folder_;
    std::size_t count_;
};

/// Renders one such picture, of the scene as it is posed.
Picture render_reference(BenchScene const& scene, Viewport viewport, int samples_per_side);

/// Folder in which references are kept unless told otherwise: $XDG_CACHE_HOME/framelet/reference, else
/// ~/.cache/framelet/reference.
std::filesystem::path default_reference_cache();

} // namespace framelet::bench
