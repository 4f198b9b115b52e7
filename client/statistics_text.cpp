#include "client/statistics_text.h"

#include <iomanip>
#include <sstream>

#include <nlohmann/json.hpp>

#include "common/counted.h"

namespace framelet {

namespace {

/// The time, seconds, as JSON; null where it was not reached.
nlohmann::json reached(double seconds) {
    return seconds < 0 ? nlohmann::json() : nlohmann::json(seconds);
}

std::string milliseconds(double seconds) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(seconds < 0.01 ? 2 : 0) << seconds * 1e3 << " ms";
    return out.str();
}

/// When something was reached, as text; `seconds` < 0: it was not.
std::string after(double seconds) {
    return seconds < 0 ? "never" : "after " + milliseconds(seconds);
}

} // namespace

std::string statistics_json(ClientStatistics const& s, RunFigures const& run) {
    nlohmann::ordered_json const out = {
        {"scene", run.scene},
        {"width", run.viewport.width},
        {"height", run.viewport.height},
        {"seconds", s.seconds},
        {"scene_seconds", run.scene_seconds},
        {"frames", run.frames},
        {"late_frames", run.late_frames},
        {"pictures", s.pictures},
        {"batches", s.batches},
        {"stale_batches", s.stale_batches},
        {"framelets", s.framelets},
        {"samples", s.samples},
        {"bytes", s.bytes},
        {"bytes_per_sample", s.bytes_per_sample()},
        {"decode_ns_per_sample", s.decode_ns_per_sample()},
        {"insert_ns_per_sample", s.samples > 0 ? s.insert_seconds * 1e9 / static_cast<double>(s.samples) : 0},
        {"reconstruct_ns_per_pixel", s.reconstruct_ns_per_pixel()},
        {"reconstructed_pixels", s.pixels},
        {"first_picture_seconds", reached(s.first_picture_seconds)},
        {"full_picture_seconds", reached(s.full_picture_seconds)},
        {"converged_seconds", reached(run.converged_seconds)},
        {"round_trip_seconds", reached(s.round_trip_seconds)},
        {"motion_to_photon_seconds", reached(run.photon_seconds)},
        {"still_difference", reached(run.still_difference)},
        {"least_round_trip_seconds", reached(s.least_round_trip_seconds)},
        {"cameras_sent", s.cameras_sent},
        {"coverage", s.coverage},
        {"cached_framelets", s.cached_framelets},
        {"cached_bytes", s.cached_bytes},
        {"lag_seconds", s.lag_seconds},
        {"server_samples_per_second", s.server_samples_per_second},
        {"server_busy", s.server_busy},
        {"converged", s.converged},
        {"reconnections", s.reconnections},
    };
    return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

std::string statistics_summary(ClientStatistics const& s, RunFigures const& run) {
    double const seconds = s.seconds > 0 ? s.seconds : 1;
    std::ostringstream out;
    out << std::fixed << std::setprecision(1);
    out << run.scene << ", " << run.viewport.width << "x" << run.viewport.height << ", " << s.seconds << " s\n"
        << "  pictures          " << static_cast<double>(s.pictures) / seconds << " a second, the first "
        << after(s.first_picture_seconds) << "\n"
        << "  network           " << static_cast<double>(s.bytes) * 8e-6 / seconds << " Mbit/s, "
        << static_cast<double>(s.bytes) * 1e-6 << " MB\n"
        << "  motion to photon  "
        << (run.photon_seconds < 0 ? "not measured: nothing moved" : milliseconds(run.photon_seconds)) << "\n"
        << "  done              " << s.coverage * 100 << "% of the picture known, "
        << (run.converged_seconds < 0 ? name_of(s.state()) : "finished " + after(run.converged_seconds)) << "\n";
    if (run.still_difference >= 0) {
        out << "  off the stills    " << std::setprecision(2) << run.still_difference * 100
            << "% of white, by mean of the sheet's moments\n"
            << std::setprecision(1);
    }
    out << "details\n"
        << "  frames            " << run.frames << " shown, " << run.late_frames << " late, " << s.pictures
        << " changed; full " << after(s.full_picture_seconds) << "\n"
        << "  clock             " << std::setprecision(2) << run.scene_seconds << " s of the scene, at the last frame\n"
        << std::setprecision(1) << "  round trip        "
        << (s.round_trip_seconds < 0
                ? "not measured"
                : milliseconds(s.round_trip_seconds) + ", least " + milliseconds(s.least_round_trip_seconds))
        << "\n"
        << "  received          " << counted(s.batches, "batch", "batches") << ", " << counted(s.framelets, "framelet")
        << ", " << static_cast<double>(s.samples) * 1e-6 << " million samples, " << std::setprecision(2)
        << s.bytes_per_sample() << " bytes/sample\n"
        << std::setprecision(1) << "  cost              decode " << s.decode_ns_per_sample()
        << " ns/sample, reconstruct " << s.reconstruct_ns_per_pixel() << " ns/pixel, cache "
        << static_cast<double>(s.cached_bytes) * 1e-6 << " MB\n"
        << "  server            " << s.server_samples_per_second * 1e-6 << " million samples/s, busy "
        << std::setprecision(0) << s.server_busy * 100 << "% of the time\n";
    return out.str();
}

} // namespace framelet
