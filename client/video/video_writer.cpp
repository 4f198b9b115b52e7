#include "client/video/video_writer.h"

#include <algorithm>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstring>
#include <utility>

#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "client/video/y4m.h"
#include "common/cpu_clock.h"
#include "common/error.h"

namespace framelet {

VideoWriter::VideoWriter(int descriptor, Viewport size, PictureRate rate, std::function<bool()> is_told_to_end)
    : descriptor_(descriptor), size_(size), rate_(rate), is_told_to_end_(std::move(is_told_to_end)), clock_(rate) {
    struct stat found {};
    bool const is_pipe = ::fstat(descriptor, &found) == 0 && S_ISFIFO(found.st_mode);
    most_bytes_ = is_pipe ? PIPE_BUF : SSIZE_MAX;
    std::signal(SIGPIPE, SIG_IGN);
    thread_ = std::thread([this] { run(); });
}

VideoWriter::~VideoWriter() {
    stop();
}

void VideoWriter::show(ShownFrame const& frame) {
    is_new_ = is_new_ || frame.changed;
    auto [before, own] = clock_.show(frame.seconds);
    std::lock_guard const lock(mutex_);
    throw_if_failed();
    if (!own || reader_is_gone_) {
        return;
    }
    // A picture for which there is no room is not taken: the one before stands in its place as well.
    bool const takes = is_new_ && waiting_.size() < most_waiting;
    if (!takes) {
        ++before;
    }
    if (before > 0 && !waiting_.empty()) {
        waiting_.back().places += before;
    } else if (before > 0) {
        waiting_.push_back({std::nullopt, before});
    }
    if (takes) {
        waiting_.push_back({frame.picture, 1});
        is_new_ = false;
    }
    changed_.notify_all();
}

void VideoWriter::stop() {
    if (thread_.joinable()) {
        {
            std::lock_guard const lock(mutex_);
            stopping_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }
}

void VideoWriter::finish() {
    stop();
    throw_if_failed();
}

std::string VideoWriter::end_reason() const {
    std::lock_guard const lock(mutex_);
    return reader_is_gone_ ? "nobody reads the video any more" : "";
}

void VideoWriter::throw_if_failed() const {
    if (failure_) {
        throw InputError(*failure_);
    }
}

void VideoWriter::run() {
    YuvMatrix const matrix = yuv_matrix(size_);
    std::string picture; // as bytes; black before anything was shown
    encode_y4m_picture(Picture(size_.width, size_.height), matrix, picture);
    std::unique_lock lock(mutex_, std::defer_lock);
    try {
        bool read = write(y4m_header(size_, rate_));
        lock.lock();
        while (read) {
            changed_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
            if (waiting_.empty()) {
                return;
            }
            Entry const entry = std::move(waiting_.front());
            waiting_.pop_front();
            lock.unlock();
            if (entry.picture) {
                encode_y4m_picture(*entry.picture, matrix, picture);
            }
            for (std::uint64_t place = 0; place < entry.places && read; ++place) {
                read = write(picture);
            }
            cpu_seconds_ = cpu_seconds_of(CLOCK_THREAD_CPUTIME_ID);
            lock.lock();
        }
        reader_is_gone_ = true;
    } catch (std::exception const& error) {
        if (!lock.owns_lock()) {
            lock.lock();
        }
        failure_ = error.what();
    }
}

/// Waits until something can be written, or an error says that nothing can; false where nobody reads any more.
bool VideoWriter::waits_for_room() const {
    constexpr int look_milliseconds = 100, most_looks = 10;
    pollfd out{descriptor_, POLLOUT, 0};
    for (int looks = 0; ::poll(&out, 1, look_milliseconds) == 0;) {
        if (is_told_to_end_() && ++looks == most_looks) {
            return false;
        }
    }
    return true;
}

bool VideoWriter::write(std::string const& bytes) {
    for (std::size_t done = 0; done < bytes.size();) {
        if (!waits_for_room()) {
            return false;
        }
        std::size_t const count = std::min(bytes.size() - done, most_bytes_);
        ssize_t const written = ::write(descriptor_, bytes.data() + done, count);
        if (written >= 0) {
            done += static_cast<std::size_t>(written);
        } else if (errno == EPIPE) {
            return false;
        } else if (errno != EINTR) {
            throw InputError(std::string("cannot write video to standard output: ") + std::strerror(errno));
        }
    }
    return true;
}

} // namespace framelet
