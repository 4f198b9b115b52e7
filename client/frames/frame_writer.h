// Writes pictures to numbered files from its own thread, so that nobody waits for compression and disk.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "client/frames/frame_sink.h"
#include "client/frames/when_written.h"
#include "common/image.h"

namespace framelet {

/// A file name with a place for the frame's number: exactly one of %d, %1d .. %9d, %01d .. %09d.
class FramePattern {
public:
    /// Throws InputError. A name without a place for a number is for one picture.
    explicit FramePattern(std::string const& text);

    bool numbered() const { return digits_ >= 0; }
    std::filesystem::path path(std::uint64_t frame) const;

private:
    std::string before_, after_;
    int digits_ = -1; ///< at least so many are written; -1: the name has no number
    char fill_ = ' ';
};

/// Frames are numbered from 0. A numbered pattern gets a file for each frame, another one only the last.
class FrameWriter : public FrameSink {
public:
    /// Makes the folder where there is none. Throws InputError where that fails.
    explicit FrameWriter(FramePattern pattern, WhenWritten when = WhenWritten::at_once);
    ~FrameWriter() override;

    /// Takes a copy of the next frame; `changed` false says that it equals the one before, which costs a copy of the
    /// file. `taken` false leaves it out; the number goes on. Waits while many frames are waiting to be written. Throws
    /// InputError once writing has failed.
    void add(Picture const& picture, bool changed, bool taken = true);
    void show(ShownFrame const& frame) override { add(frame.picture, frame.changed, frame.chosen); }
    void finish() override;
    double cpu_seconds() const override { return cpu_seconds_; }

private:
    struct Frame {
        std::uint64_t number;
        std::optional<Picture> picture; ///< empty: as the one that was written before
    };
    static constexpr std::size_t most_waiting = 4;
    static constexpr std::size_t most_kept_bytes = std::size_t{256} << 20;

    void run();
    void write(Frame const& frame);
    void stop();
    void throw_if_failed() const;

    FramePattern const pattern_;
    std::uint64_t frames_ = 0;
    bool is_new_ = true; ///< the picture has changed since the last frame that was taken
    std::optional<Picture> last_; ///< the newest picture, where the pattern has no number
    std::atomic<double> cpu_seconds_ = 0;
    std::filesystem::path newest_file_; ///< the newest that was written; used by the writing thread only

    std::mutex mutex_; // guards what follows
    std::condition_variable changed_;
    std::deque<Frame> waiting_;
    std::vector<Picture> written_; ///< their memory is taken again
    bool writes_; ///< what waits is written; else it is kept
    bool stopping_ = false;
    std::optional<std::string> failure_;

    std::thread thread_;
};

} // namespace framelet
