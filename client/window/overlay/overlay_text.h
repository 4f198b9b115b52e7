// The words and plots of the overlay. In: statistics now and a moment ago. Out: rows of text, figures and their course.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "client/core/client_core.h"
#include "client/window/overlay/overlay_content.h"

namespace framelet {

/// The figures of the last half second or so: display frames, pictures, bytes.
class RateMeter {
public:
    /// A display frame was shown, which took so long to make.
    void frame(double seconds_taken);
    /// The picture that is shown has changed; `photon_seconds` as in ClientStatistics.
    void picture(double photon_seconds);
    /// Closes the interval where it is at least half a second old; true when the figures are new.
    bool update(double now_seconds, std::uint64_t bytes);

    double frames_per_second() const { return frames_per_second_; }
    double pictures_per_second() const { return pictures_per_second_; }
    double frame_seconds() const { return frame_seconds_; } ///< mean
    double photon_seconds() const { return photon_seconds_; } ///< median; -1: nothing newer was shown
    double bytes_per_second() const { return bytes_per_second_; }

private:
    double start_ = 0;
    std::uint64_t start_bytes_ = 0;
    int frames_ = 0;
    int pictures_ = 0;
    double taken_ = 0;
    std::vector<double> photons_;
    double frames_per_second_ = 0;
    double pictures_per_second_ = 0;
    double frame_seconds_ = 0;
    double photon_seconds_ = -1;
    double bytes_per_second_ = 0;
};

/// The course of the figures in the last minute.
class StatisticsHistory {
public:
    /// Adds the figures of one interval of the meter.
    void add(RateMeter const& meter, ClientStatistics const& statistics);
    /// The plots of all figures, with their values in the newest interval beside them.
    std::vector<Plot> plots() const;

private:
    struct Interval {
        double pictures_per_second, photon_seconds, bits_per_second, samples_per_second, server_busy;
    };
    std::vector<Interval> intervals_; ///< the oldest first
};

/// The figures that most people want to know.
TextRows figure_rows(ClientStatistics const& statistics, TimeLine const& time, bool controls);
/// The figures for who looks into what it costs.
TextRows detail_rows(ClientStatistics const& statistics, RateMeter const& meter, Viewport viewport,
                     std::string const& painter);
/// Says what the figure of this name is, for its tooltip: one of a plot or of either kind of rows.
std::string figure_tip(std::string const& name);
/// A text about a scene that is being opened, and the stage that this has reached; empty where there is no scene.
std::string opening_text(std::string const& scene, std::string const& stage);
/// What the small sign at the upper edge says, a line each.
struct Signs {
    std::string opening = {}; ///< of the scene that is being opened; empty: none is
    bool is_interrupted = false; ///< there is no session, and another is tried for
    bool has_mouse_look = false;
    std::string recording = {}; ///< of the film that is being recorded; empty: none is
};
std::string sign_text(Signs const& signs);
/// What is said of a picture that was saved. `lacks`: what is missing in it. `state`: of the picture as it was then.
std::string saved_text(std::string const& file, std::string const& lacks, PictureState state);
/// The clock as text: "1.50 of 4.00 s, playing at 2x".
std::string clock_text(TimeLine const& time);
/// The lag as text: "the scene 100 ms late".
std::string lag_text(double lag_seconds);

} // namespace framelet
