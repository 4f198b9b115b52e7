// Checks what a viewer shows once all has come to rest: the very picture that a viewer who comes only then is shown,
// whatever it had seen before. In: scenes, size, machine, how many pauses. Out: figures of the server's stream and the
// viewer's picture maker on a virtual clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "common/image.h"
#include "tests/evaluation/bench_scene.h"

namespace framelet::bench {

/// The ways of coming to rest.
enum class Stop : std::uint8_t {
    scene_camera, ///< seen through a camera of the scene, the clock is paused
    own_camera, ///< the viewer's own camera flies, stands, and the clock is paused
    seek, ///< the clock is paused and then set to another time
    clip_end, ///< the clock is set to just before the end of the animation, and paused as it gets there
    resize, ///< the clock is paused and then the picture gets another size
};
inline constexpr std::size_t stop_count = 5;

/// Seconds within which what has come to rest is seen as a whole, be it coarsely.
inline constexpr double soon_seconds = 0.3;

/// Name of a way, as it is printed.
std::string name_of(Stop stop);

struct PauseOptions {
    Viewport viewport{160, 90};
    double rate = 5; ///< samples a pixel and second
    std::uint64_t seed = 1;
};

struct PauseOutcome {
    bool is_complete = false; ///< the viewer was told that its picture is complete, within a minute
    int differing = 0; ///< pixels that are not those of a viewer who came after the pause
    /// Mean squared errors, against the complete picture, `soon_seconds` after it came to rest and after the other
    /// came.
    double soon = 0, fresh_soon = 0;
    Picture soon_shown, shown, fresh;
};

/// Plays the scene for up to a second, from a random time on, through a random one of its cameras that move if any
/// does, and comes to rest. The same seed gives the same outcome.
PauseOutcome pause_once(BenchScene& scene, Stop stop, PauseOptions const& options);

/// Pauses `count` times, over the scenes and ways of coming to rest in turn. Prints and returns a row for each scene:
/// pauses, how many were `equal` to a fresh viewer's picture, the pixels that were not, and the mean `soon` and
/// `fresh_soon`. Where `charts` is not empty the pictures that differ are written there.
nlohmann::json measure_pauses(std::span<std::filesystem::path const> scenes, std::size_t count,
                              PauseOptions const& options, std::filesystem::path const& charts);

} // namespace framelet::bench
