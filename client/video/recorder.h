// Writes what is seen to a film, on a thread of its own. In: pictures, and when each was shown. Out: a file; where it
// is, how far it has got.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "client/frames/when_written.h"
#include "client/video/film_writer.h"
#include "common/image.h"

namespace framelet {

class Recorder {
public:
    /// `most_waiting`: most pictures that wait to be written, at least one. `begin`: when they are written.
    explicit Recorder(std::unique_ptr<FilmWriter> writer, std::size_t most_waiting = 6,
                      WhenWritten begin = WhenWritten::at_once);
    /// Waits until what was taken is written.
    ~Recorder();
    Recorder(Recorder const&) = delete;
    Recorder& operator=(Recorder const&) = delete;

    /// Adds a copy of a picture that is shown `seconds` after the film began; never waits. While many wait to be
    /// written the picture is left out.
    void add(Picture const& picture, double seconds);
    /// The film ends at that time, with what was added last: the thread writes what still waits, and is done then.
    void stop(double seconds);

    /// Waits, after `stop`, until the film is written.
    void wait();

    struct Progress {
        std::uint64_t pictures = 0; ///< taken into the film
        std::uint64_t left_out = 0;
        double seconds = 0; ///< the film's length by now
        bool is_stopped = false;
        bool is_done = false; ///< nothing will be written any more
        std::optional<std::string> failure; ///< one line
    };
    Progress progress() const;
    std::filesystem::path path() const { return path_; }
    /// Processor seconds that its thread has taken so far. May be called from any thread.
    double cpu_seconds() const { return cpu_seconds_; }

private:
    struct Frame {
        Picture picture;
        double seconds;
    };
    void run();

    std::unique_ptr<FilmWriter> writer_; ///< used by the thread only
    std::filesystem::path const path_;
    std::size_t const most_waiting_;

    mutable std::mutex mutex_; // guards what follows
    std::condition_variable changed_;
    std::deque<Frame> waiting_;
    std::vector<Picture> spare_; ///< whose memory is used again
    Progress progress_;
    std::optional<double> end_;
    bool writes_; ///< what waits is written; else it is held back while there is room

    std::atomic<double> cpu_seconds_ = 0;
    std::thread thread_;
};

/// The progress in a line for people: "recording 12 s, 360 pictures, 30 a second".
std::string progress_text(Recorder::Progress const& progress);
/// The result in a line for people: "saved PATH: 12.3 s, 360 pictures, 30 a second, 4.1 MB", or why not.
std::string result_text(Recorder::Progress const& progress, std::filesystem::path const& path);

} // namespace framelet
