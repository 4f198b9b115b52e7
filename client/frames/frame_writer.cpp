#include "client/frames/frame_writer.h"

#include <utility>

#include "client/frames/output_folder.h"
#include "common/cpu_clock.h"
#include "common/error.h"
#include "common/files/picture_writer.h"

namespace framelet {

namespace fs = std::filesystem;

namespace {

void write_picture(fs::path const& file, Picture const& picture) {
    file.extension() == ".ppm" ? write_ppm(file, picture) : write_png(file, picture);
}

} // namespace

FramePattern::FramePattern(std::string const& text) {
    auto const fail = [&] {
        return InputError(
            "cannot use \"" + text +
            "\" as output: give the name of a .png or .ppm file, or of a film, .webp or .mp4; one %04d in a "
            "picture's name (any number of digits up to 9) stands for the frame's number, as in frames/%04d.png");
    };
    std::size_t const percent = text.find('%');
    before_ = text.substr(0, percent);
    if (percent != std::string::npos) {
        std::size_t place = percent + 1;
        auto const digit = [&] { return place < text.size() && text[place] >= '0' && text[place] <= '9'; };
        if (digit() && text[place] == '0') {
            fill_ = '0';
            ++place;
        }
        digits_ = 1;
        if (digit()) {
            digits_ = text[place] - '0';
            ++place;
        } else if (fill_ == '0') {
            throw fail();
        }
        if (digits_ == 0 || place >= text.size() || text[place] != 'd' || text.find('%', place) != std::string::npos) {
            throw fail();
        }
        after_ = text.substr(place + 1);
    }
    if (text.find('\0') != std::string::npos || (path(0).extension() != ".png" && path(0).extension() != ".ppm")) {
        throw fail();
    }
}

fs::path FramePattern::path(std::uint64_t frame) const {
    if (digits_ < 0) {
        return before_;
    }
    std::string number = std::to_string(frame);
    if (number.size() < static_cast<std::size_t>(digits_)) {
        number.insert(0, static_cast<std::size_t>(digits_) - number.size(), fill_);
    }
    return before_ + number + after_;
}

FrameWriter::FrameWriter(FramePattern pattern, WhenWritten when)
    : pattern_(std::move(pattern)), writes_(when == WhenWritten::at_once) {
    make_folder_of(pattern_.path(0));
    thread_ = std::thread([this] { run(); });
}

FrameWriter::~FrameWriter() {
    stop();
}

void FrameWriter::add(Picture const& picture, bool changed, bool taken) {
    Frame frame{frames_++, std::nullopt};
    if (!pattern_.numbered()) {
        if (changed || !last_) {
            last_ = picture;
        }
        return;
    }
    is_new_ = is_new_ || changed;
    if (!taken) {
        return;
    }
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !writes_ || waiting_.size() < most_waiting || failure_; });
    throw_if_failed();
    if (std::exchange(is_new_, false)) {
        if (written_.empty()) {
            written_.emplace_back();
        }
        frame.picture = std::move(written_.back());
        written_.pop_back();
        lock.unlock();
        *frame.picture = picture;
        lock.lock();
    }
    writes_ = writes_ || waiting_.size() * picture.rgba.size() > most_kept_bytes;
    waiting_.push_back(std::move(frame));
    changed_.notify_all();
}

void FrameWriter::stop() {
    if (thread_.joinable()) {
        {
            std::lock_guard const lock(mutex_);
            stopping_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }
}

void FrameWriter::finish() {
    stop();
    throw_if_failed();
    if (last_) {
        write_picture(pattern_.path(0), *last_);
    }
}

void FrameWriter::throw_if_failed() const {
    if (failure_) {
        throw InputError(*failure_);
    }
}

void FrameWriter::run() {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return stopping_ || (writes_ && !waiting_.empty()); });
        if (waiting_.empty()) {
            return;
        }
        Frame frame = std::move(waiting_.front());
        waiting_.pop_front();
        changed_.notify_all();
        lock.unlock();
        std::optional<std::string> failure;
        try {
            write(frame);
            cpu_seconds_ = cpu_seconds_of(CLOCK_THREAD_CPUTIME_ID);
        } catch (std::exception const& error) {
            failure = error.what();
        }
        lock.lock();
        if (failure) {
            failure_ = std::move(failure);
            changed_.notify_all();
            return;
        }
        if (frame.picture) {
            written_.push_back(std::move(*frame.picture));
        }
    }
}

void FrameWriter::write(Frame const& frame) {
    fs::path const file = pattern_.path(frame.number);
    if (frame.picture) {
        write_picture(file, *frame.picture);
    } else {
        fs::copy_file(newest_file_, file, fs::copy_options::overwrite_existing);
    }
    newest_file_ = file;
}

} // namespace framelet
