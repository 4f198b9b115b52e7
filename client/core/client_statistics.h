// Figures of a viewer's session. A value.
#pragma once

#include <cstdint>
#include <vector>

namespace framelet {

/// Share of the viewport from which on a picture counts as full: while something moves some pixels come into view in
/// each, and are filled from their neighbours.
inline constexpr double full_coverage = 0.99;

/// How far the picture has come.
enum class PictureState : std::uint8_t {
    coarse, ///< some places have fewer samples than pixels, as what moves mostly has
    refining, ///< more samples, or exact ones, are still to come
    finished, ///< nothing more will come until something changes
};

/// Counts and times since the viewer's first session was opened.
struct ClientStatistics {
    double seconds = 0;
    std::uint64_t pictures = 0; ///< calls of `update_picture` that changed something
    std::uint64_t batches = 0;
    std::uint64_t stale_batches = 0; ///< for a viewport that is no longer current; not shown
    std::uint64_t framelets = 0;
    std::uint64_t samples = 0;
    std::uint64_t bytes = 0; ///< of batches: samples, shapes, tracks, tiles and headers
    std::uint64_t pixels = 0; ///< reconstructed
    double decode_seconds = 0; ///< by the clock, as the next two, whatever processors were at work
    double insert_seconds = 0;
    double reconstruct_seconds = 0;
    double first_picture_seconds = -1; ///< from the first camera to the first picture; -1: not yet
    double full_picture_seconds = -1; ///< from the first camera until `full_coverage` was reached; -1: not yet
    double round_trip_seconds = -1; ///< camera sent -> first batch seen from it received; smoothed
    double least_round_trip_seconds = -1;
    double coverage = 0; ///< share of the viewport that is covered now, [0, 1]
    std::uint64_t cached_framelets = 0;
    std::uint64_t cached_bytes = 0;
    std::uint64_t waiting_bytes = 0; ///< of batches that have been decoded, for the next picture
    std::uint64_t cameras_sent = 0;
    double server_samples_per_second = 0;
    double server_busy = 0; ///< the share of the last second that it had something to do, [0, 1]
    bool is_fine = false; ///< every place has a sample a pixel or more, of what stands
    bool converged = false; ///< the server has nothing more to say about the newest view, and all of it has come
    /// Seconds from when the camera of the last picture was set, or the moment that it shows was the present, until the
    /// picture was seen; -1: it shows nothing new.
    double photon_seconds = -1;
    double lag_seconds = 0; ///< by which the scene is shown late, as asked for; 0: it is not
    std::uint64_t reconnections = 0;

    PictureState state() const;
    double bytes_per_sample() const;
    double decode_ns_per_sample() const;
    double reconstruct_ns_per_pixel() const;
};

/// The state in one word.
char const* name_of(PictureState state);

/// The median of times, seconds; -1 where there are none.
double median_seconds(std::vector<double> times);

} // namespace framelet
