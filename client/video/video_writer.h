// Writes a video of constant rate to an open file, mostly a pipe, from a thread of its own: what is shown never waits
// for who reads it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "client/frames/frame_sink.h"
#include "client/video/video_clock.h"
#include "common/camera.h"

namespace framelet {

/// Writes YUV4MPEG2. The video is as long as the run is, whatever the reader's speed: pictures are repeated where none
/// was shown in time or too many wait, and left out where several were.
class VideoWriter : public FrameSink {
public:
    /// `descriptor` stays open. From then on the program ignores SIGPIPE: a reader that goes is an end reason. Once
    /// `is_told_to_end` says so, one that reads nothing for a second is as good as gone.
    VideoWriter(int descriptor, Viewport size, PictureRate rate, std::function<bool()> is_told_to_end);
    ~VideoWriter() override;

    void show(ShownFrame const& frame) override;
    void finish() override;
    std::string end_reason() const override;
    double cpu_seconds() const override { return cpu_seconds_; }

private:
    struct Entry {
        std::optional<Picture> picture; ///< empty: as the one before
        std::uint64_t places;
    };
    static constexpr std::size_t most_waiting = 4;

    void run();
    /// Writes all bytes; false where nobody reads any more. Throws InputError.
    bool write(std::string const& bytes);
    bool waits_for_room() const;
    void stop();
    void throw_if_failed() const;

    int const descriptor_;
    Viewport const size_;
    PictureRate const rate_;
    std::function<bool()> const is_told_to_end_;
    std::size_t most_bytes_; ///< that are written at once without waiting, where there is room
    VideoClock clock_;
    bool is_new_ = true; ///< the picture has changed since the last one that got a place
    std::atomic<double> cpu_seconds_ = 0;

    mutable std::mutex mutex_; // guards what follows
    std::condition_variable changed_;
    std::deque<Entry> waiting_;
    bool stopping_ = false;
    bool reader_is_gone_ = false;
    std::optional<std::string> failure_;

    std::thread thread_;
};

} // namespace framelet
