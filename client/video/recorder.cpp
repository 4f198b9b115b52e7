#include "client/video/recorder.h"

#include <algorithm>
#include <exception>
#include <iomanip>
#include <sstream>
#include <utility>

#include <sys/resource.h>

#include "common/counted.h"
#include "common/cpu_clock.h"

namespace framelet {

namespace fs = std::filesystem;

Recorder::Recorder(std::unique_ptr<FilmWriter> writer, std::size_t most_waiting, WhenWritten begin)
    : writer_(std::move(writer)), path_(writer_->path()), most_waiting_(most_waiting),
      writes_(begin == WhenWritten::at_once) {
    thread_ = std::thread([this] { run(); });
}

Recorder::~Recorder() {
    stop(progress().seconds);
    thread_.join();
}

void Recorder::add(Picture const& picture, double seconds) {
    std::unique_lock lock(mutex_);
    if (end_ || progress_.is_done) {
        return;
    }
    progress_.seconds = std::max(progress_.seconds, seconds);
    if (waiting_.size() >= most_waiting_) {
        ++progress_.left_out;
        return;
    }
    writes_ = writes_ || waiting_.size() + 1 == most_waiting_;
    Frame frame{{}, progress_.seconds};
    if (!spare_.empty()) {
        frame.picture = std::move(spare_.back());
        spare_.pop_back();
    }
    ++progress_.pictures;
    lock.unlock();
    frame.picture = picture; // into the memory of an earlier one
    lock.lock();
    waiting_.push_back(std::move(frame));
    changed_.notify_all();
}

void Recorder::stop(double seconds) {
    std::lock_guard const lock(mutex_);
    if (!end_) {
        progress_.seconds = std::max(progress_.seconds, seconds);
        progress_.is_stopped = true;
        end_ = progress_.seconds;
        changed_.notify_all();
    }
}

void Recorder::wait() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return progress_.is_done; });
}

Recorder::Progress Recorder::progress() const {
    std::lock_guard const lock(mutex_);
    return progress_;
}

void Recorder::run() {
    // Linux has a priority for each thread: what is shown goes before what is written.
    constexpr int nicer = 5;
    ::setpriority(PRIO_PROCESS, 0, ::getpriority(PRIO_PROCESS, 0) + nicer);
    Frame last{{}, -1};
    std::optional<std::string> failure;
    try {
        std::unique_lock lock(mutex_);
        for (;;) {
            changed_.wait(lock, [this] { return end_ || (writes_ && !waiting_.empty()); });
            if (waiting_.empty()) {
                break;
            }
            std::swap(last, waiting_.front());
            if (!waiting_.front().picture.rgba.empty() && spare_.size() < most_waiting_) {
                spare_.push_back(std::move(waiting_.front().picture));
            }
            waiting_.pop_front();
            lock.unlock();
            writer_->add(last.picture, last.seconds);
            cpu_seconds_ = cpu_seconds_of(CLOCK_THREAD_CPUTIME_ID);
            lock.lock();
        }
        double const end = *end_;
        lock.unlock();
        if (end > last.seconds && last.seconds >= 0) { // a picture is shown until the next one
            writer_->add(last.picture, end);
        }
        writer_->finish();
        cpu_seconds_ = cpu_seconds_of(CLOCK_THREAD_CPUTIME_ID);
    } catch (std::exception const& error) {
        failure = error.what();
    }
    std::lock_guard const lock(mutex_);
    progress_.failure = std::move(failure);
    progress_.is_done = true;
    waiting_.clear();
    changed_.notify_all();
}

namespace {

/// The film's pictures as text: how many, how many a second, and how many are left out, which do not count.
std::string pictures_text(Recorder::Progress const& progress) {
    constexpr double least_seconds = 1; // before that the rate would jump about
    std::ostringstream out;
    out << counted(progress.pictures, "picture");
    if (progress.seconds >= least_seconds) {
        out << ", " << std::fixed << std::setprecision(0) << static_cast<double>(progress.pictures) / progress.seconds
            << " a second";
    }
    if (progress.left_out > 0) {
        out << ", " << progress.left_out << " left out";
    }
    return out.str();
}

} // namespace

std::string progress_text(Recorder::Progress const& progress) {
    std::ostringstream out;
    out << (progress.is_stopped ? "writing the film, " : "recording ") << std::fixed << std::setprecision(0)
        << progress.seconds << " s, " << pictures_text(progress);
    return out.str();
}

std::string result_text(Recorder::Progress const& progress, fs::path const& path) {
    if (progress.failure) {
        return "the film is not written: " + *progress.failure;
    }
    std::ostringstream out;
    out << "saved " << path.string() << ": " << std::fixed << std::setprecision(1) << progress.seconds << " s, "
        << pictures_text(progress);
    std::error_code error;
    if (auto const bytes = fs::file_size(path, error); !error) {
        out << ", " << static_cast<double>(bytes) * 1e-6 << " MB";
    }
    return out.str();
}

} // namespace framelet
