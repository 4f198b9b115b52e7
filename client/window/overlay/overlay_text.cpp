#include "client/window/overlay/overlay_text.h"

#include <algorithm>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <string_view>
#include <utility>

#include "client/viewer/commands.h"
#include "client/viewer/lacks.h"
#include "common/counted.h"

namespace framelet {

namespace {

constexpr double interval_seconds = 0.5;
constexpr std::size_t most_intervals = 120; // a minute
constexpr char const* interrupted_text = "no connection: trying again";

std::string fixed(double value, int digits, char const* unit) {
    std::ostringstream out;
    out << std::fixed << std::setprecision(digits) << value << unit;
    return out.str();
}

std::string done_text(ClientStatistics const& s) {
    std::string const state = name_of(s.state());
    return s.state() == PictureState::finished ? state : state + ", " + fixed(s.coverage * 100, 0, "% known");
}

} // namespace

void RateMeter::frame(double seconds_taken) {
    ++frames_;
    taken_ += seconds_taken;
}

void RateMeter::picture(double photon_seconds) {
    ++pictures_;
    if (photon_seconds >= 0) {
        photons_.push_back(photon_seconds);
    }
}

bool RateMeter::update(double now_seconds, std::uint64_t bytes) {
    double const elapsed = now_seconds - start_;
    if (elapsed >= 0 && elapsed < interval_seconds) {
        return false;
    }
    frames_per_second_ = elapsed > 0 ? frames_ / elapsed : 0;
    pictures_per_second_ = elapsed > 0 ? pictures_ / elapsed : 0;
    frame_seconds_ = frames_ > 0 ? taken_ / frames_ : 0;
    photon_seconds_ = median_seconds(std::exchange(photons_, {}));
    bytes_per_second_ = elapsed > 0 && bytes >= start_bytes_ ? static_cast<double>(bytes - start_bytes_) / elapsed : 0;
    start_ = now_seconds;
    start_bytes_ = bytes;
    frames_ = 0;
    pictures_ = 0;
    taken_ = 0;
    return true;
}

void StatisticsHistory::add(RateMeter const& meter, ClientStatistics const& statistics) {
    if (intervals_.size() == most_intervals) {
        intervals_.erase(intervals_.begin());
    }
    intervals_.push_back({meter.pictures_per_second(), meter.photon_seconds(), 8 * meter.bytes_per_second(),
                          statistics.server_samples_per_second, statistics.server_busy});
}

std::vector<Plot> StatisticsHistory::plots() const {
    Interval const now = intervals_.empty() ? Interval{0, -1, 0, 0, 0} : intervals_.back();
    std::vector<Plot> out{
        {"pictures", fixed(now.pictures_per_second, 0, " a second"), {}},
        {"motion to photon", now.photon_seconds < 0 ? "nothing moved" : fixed(now.photon_seconds * 1e3, 0, " ms"), {}},
        {"network", fixed(now.bits_per_second * 1e-6, 1, " Mbit/s"), {}},
        {"server renders", fixed(now.samples_per_second * 1e-6, 2, " million samples/s"), {}},
        {"server busy", fixed(now.server_busy * 100, 0, "% of the time"), {}, 1},
    };
    for (Interval const& interval : intervals_) {
        double const values[] = {interval.pictures_per_second, interval.photon_seconds, interval.bits_per_second,
                                 interval.samples_per_second, interval.server_busy};
        for (std::size_t i = 0; i < out.size(); ++i) {
            out[i].values.push_back(static_cast<float>(values[i]));
        }
    }
    return out;
}

TextRows figure_rows(ClientStatistics const& s, TimeLine const& time, bool controls) {
    return {
        {"done", done_text(s)},
        {"clock", clock_text(time) + (s.lag_seconds > 0 ? "; " + lag_text(s.lag_seconds) : "") +
                      (controls ? "" : std::string("; ") + watching_text)},
    };
}

TextRows detail_rows(ClientStatistics const& s, RateMeter const& meter, Viewport viewport, std::string const& painter) {
    return {
        {"picture", std::to_string(viewport.width) + "x" + std::to_string(viewport.height)},
        {"painted by", painter},
        {"display", fixed(meter.frames_per_second(), 0, " frames/s, ") + fixed(meter.frame_seconds() * 1e3, 1, " ms")},
        {"round trip", s.round_trip_seconds < 0 ? "not measured"
                                                : fixed(s.round_trip_seconds * 1e3, 0, " ms (least ") +
                                                      fixed(s.least_round_trip_seconds * 1e3, 0, " ms)")},
        {"received", counted(s.batches, "batch", "batches") + ", " + counted(s.framelets, "framelet") + ", " +
                         fixed(s.bytes_per_sample(), 2, " B/sample")},
        {"cost",
         fixed(s.decode_ns_per_sample(), 1, " ns/sample, ") + fixed(s.reconstruct_ns_per_pixel(), 1, " ns/pixel")},
        {"cache",
         counted(s.cached_framelets, "framelet") + ", " + fixed(static_cast<double>(s.cached_bytes) * 1e-6, 1, " MB")},
    };
}

std::string figure_tip(std::string const& name) {
    static constexpr std::pair<std::string_view, char const*> tips[] = {
        {"pictures", "how often a second what is shown changed"},
        {"motion to photon", "from when the camera was set, or the moment that is shown was the present, until the "
                             "picture of it was shown: the median of half a second"},
        {"network", "what is received in batches of framelets"},
        {"server renders", "samples a second, for all viewers"},
        {"server busy", "the share of the last second in which the server had something to do for viewers"},
        {"done",
         "coarse: in places with fewer samples than pixels, as while anything moves; refining: a sample a pixel "
         "or more, and better ones to come; finished: exact. Known is what any sample shows"},
        {"clock", "the scene's: Space lets it run and stops it"},
        {"picture", "the window's size, pixels"},
        {"painted by", "what paints that which moves: the graphics card, or the processor and why"},
        {"display", "frames a second that were drawn for the window, what lies over the picture included, and how long "
                    "drawing one took"},
        {"round trip", "from a camera sent to the first batch seen from it, smoothed, and the least"},
        {"received",
         "since the viewer first connected: batches (what comes in one message), framelets (tiles of 16x16 samples), "
         "and bytes for each sample"},
        {"cost", "how long this machine takes to decode a sample, and to make a pixel of the picture"},
        {"cache", "framelets that are held, and the memory for them"},
    };
    auto const* const found =
        std::ranges::find(tips, std::string_view(name), [](auto const& tip) { return tip.first; });
    return found == std::end(tips) ? "" : found->second;
}

std::string sign_text(Signs const& signs) {
    std::string text;
    for (std::string const& line : {signs.opening, std::string(signs.is_interrupted ? interrupted_text : ""),
                                    std::string(signs.has_mouse_look ? mouse_look_text : ""), signs.recording}) {
        text += (text.empty() || line.empty() ? "" : "\n") + line;
    }
    return text;
}

std::string opening_text(std::string const& scene, std::string const& stage) {
    return scene.empty() ? "" : "opening " + scene + (stage.empty() ? " ..." : ": " + stage);
}

std::string saved_text(std::string const& file, std::string const& lacks, PictureState state) {
    return "saved " + file + lacks +
           (state == PictureState::finished ? "" : std::string("; it was not finished: still ") + name_of(state));
}

std::string clock_text(TimeLine const& time) {
    if (time.duration <= 0) {
        return nothing_moves_text;
    }
    std::ostringstream out;
    out << std::fixed << std::setprecision(2) << time.clock.time << " s (every " << time.duration << " s), "
        << (time.clock.playing ? "playing" : "paused");
    if (time.clock.speed != 1) {
        out << std::defaultfloat << " at " << time.clock.speed << "x";
    }
    return out.str();
}

std::string lag_text(double lag_seconds) {
    return "the scene " + fixed(lag_seconds * 1e3, 0, " ms late");
}

} // namespace framelet
