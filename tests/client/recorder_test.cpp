#include "client/video/recorder.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <fstream>

#include <gtest/gtest.h>

#include "client/video/film_sink.h"
#include "client/window/kept/film_file.h"
#include "common/error.h"
#include "tests/client/own_folder.h"

namespace framelet {
namespace {

/// The record of what a writer was given, and a way to keep it busy.
struct Log {
    std::mutex mutex;
    std::condition_variable changed;
    bool is_held = false; ///< `add` waits
    std::vector<std::pair<int, double>> added; ///< width and time
    bool is_finished = false;
    bool fails = false;

    void release() {
        std::lock_guard const lock(mutex);
        is_held = false;
        changed.notify_all();
    }
    template <class Condition>
    void wait(Condition condition) {
        std::unique_lock lock(mutex);
        changed.wait(lock, condition);
    }
};

class LoggingWriter final : public FilmWriter {
public:
    explicit LoggingWriter(Log& log) : log_(log) {}
    void add(Picture const& picture, double seconds) override {
        std::unique_lock lock(log_.mutex);
        log_.added.emplace_back(picture.width, seconds);
        log_.changed.notify_all();
        log_.changed.wait(lock, [this] { return !log_.is_held; });
        if (log_.fails) {
            throw InputError("the disk is full");
        }
    }
    void finish() override { log_.is_finished = true; }
    std::filesystem::path path() const override { return "film"; }

private:
    Log& log_;
};

TEST(Recorder, WritesInOrderAndHoldsTheLastPictureToTheEnd) {
    Log log;
    {
        Recorder recorder(std::make_unique<LoggingWriter>(log));
        recorder.add(Picture(1, 1), 0);
        recorder.add(Picture(2, 1), 0.5);
        recorder.stop(2);
        recorder.add(Picture(3, 1), 3); // too late
        EXPECT_TRUE(recorder.progress().is_stopped);
        EXPECT_EQ(recorder.progress().pictures, 2u);
    }
    EXPECT_TRUE(log.is_finished);
    EXPECT_EQ(log.added, (std::vector<std::pair<int, double>>{{1, 0}, {2, 0.5}, {2, 2}}));
}

TEST(Recorder, NeverWaitsAndLeavesOutWhatIsTooMuch) {
    Log log;
    log.is_held = true;
    constexpr std::size_t most_waiting = 6;
    Recorder recorder(std::make_unique<LoggingWriter>(log), most_waiting);
    recorder.add(Picture(1, 1), 0);
    log.wait([&] { return log.added.size() == 1; }); // the writer has it, the queue is empty
    for (int i = 0; i < 20; ++i) {
        recorder.add(Picture(2 + i, 1), 1 + i);
    }
    Recorder::Progress progress = recorder.progress();
    EXPECT_EQ(progress.pictures, 1 + most_waiting);
    EXPECT_EQ(progress.left_out, 20 - most_waiting);
    EXPECT_EQ(progress.seconds, 20);
    EXPECT_NE(progress_text(progress).find("14 left out"), std::string::npos);
    progress.seconds = 2;
    progress.pictures = 50;
    EXPECT_EQ(progress_text(progress), "recording 2 s, 50 pictures, 25 a second, 14 left out");
    log.release();
    log.wait([&] { return log.added.size() == 1 + most_waiting; });
    EXPECT_EQ(log.added[1], std::pair(2, 1.0));
}

TEST(Recorder, HoldsBackWhileThereIsRoom) {
    Log log;
    Recorder recorder(std::make_unique<LoggingWriter>(log), 3, WhenWritten::at_the_end);
    auto const added = [&] {
        std::lock_guard const lock(log.mutex);
        return log.added.size();
    };
    recorder.add(Picture(1, 1), 0);
    recorder.add(Picture(2, 1), 1);
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_EQ(added(), 0u);
    recorder.add(Picture(3, 1), 2);
    log.wait([&] { return log.added.size() == 3; });

    Log at_the_end;
    Recorder kept(std::make_unique<LoggingWriter>(at_the_end), 3, WhenWritten::at_the_end);
    kept.add(Picture(1, 1), 0);
    kept.stop(0);
    kept.wait();
    EXPECT_EQ(at_the_end.added.size(), 1u);
}

TEST(Recorder, AFailureEndsItWithALine) {
    Log log;
    log.fails = true;
    Recorder recorder(std::make_unique<LoggingWriter>(log));
    recorder.add(Picture(1, 1), 0);
    recorder.wait();
    recorder.add(Picture(1, 1), 1);
    EXPECT_EQ(result_text(recorder.progress(), recorder.path()), "the film is not written: the disk is full");
}

TEST(Recorder, MakesAFilm) {
    OwnFolder const folder;
    Recorder recorder(make_film_file(folder.path()));
    for (int i = 0; i < 4; ++i) {
        Picture picture(i < 2 ? 65 : 81, 49); // odd, and of another size from the third on
        std::ranges::fill(picture.rgba, static_cast<std::uint8_t>(60 * i));
        recorder.add(picture, 0.1 * i);
    }
    recorder.stop(0.5);
    recorder.wait();
    EXPECT_EQ(recorder.progress().failure, std::nullopt);
    if (recorder.path().extension() == ".mp4") {
        EXPECT_GT(std::filesystem::file_size(recorder.path()), 500u);
        std::string head(12, '\0');
        std::ifstream(recorder.path(), std::ios::binary).read(head.data(), 12);
        EXPECT_EQ(head.substr(4, 4), "ftyp");
        EXPECT_NE(result_text(recorder.progress(), recorder.path()).find(": 0.5 s, 4 pictures"), std::string::npos);
    } else {
        EXPECT_TRUE(std::filesystem::exists(recorder.path() / "00000.png"));
    }
}

std::string read_bytes(std::filesystem::path const& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(FilmSink, MakesAnAnimation) {
    OwnFolder const folder;
    std::filesystem::path const file = folder.path() / "made" / "film.webp";
    if (!can_write_film(file)) {
        GTEST_SKIP() << "built without the encoder";
    }
    FilmSink sink(file, {65, 49});
    Picture picture(65, 49);
    for (int i = 0; i < 7; ++i) {
        std::ranges::fill(picture.rgba, static_cast<std::uint8_t>(40 * i));
        sink.show({picture, i != 0 && i != 4, true, 0.1 * i}); // what nobody has seen, and what has not changed
    }
    sink.finish();
    EXPECT_NE(sink.result().find("film.webp: 0.5 s, 5 pictures"), std::string::npos) << sink.result();
    std::string const bytes = read_bytes(file);
    EXPECT_EQ(bytes.substr(0, 4) + bytes.substr(8, 4), "RIFFWEBP");
    std::size_t frames = 0;
    for (std::size_t at = bytes.find("ANMF"); at != std::string::npos; at = bytes.find("ANMF", at + 4)) {
        ++frames;
    }
    EXPECT_GE(frames, 5u);
    EXPECT_LE(frames, 6u) << "and the last one's end";
    std::size_t const loops = bytes.find("ANIM") + 12;
    EXPECT_EQ(bytes.substr(loops, 2), std::string(2, '\0')) << "for ever";
}

TEST(FilmSink, WhatCannotBeWrittenIsALine) {
    EXPECT_THROW(FilmSink("film.avi", {64, 64}), InputError);
    EXPECT_THROW(FilmSink("/dev/null/nowhere/film.mp4", {64, 64}), InputError);
    if (can_write_film("/dev/full.webp")) {
        OwnFolder const folder;
        std::filesystem::create_symlink("/dev/full", folder.path() / "film.webp");
        FilmSink sink(folder.path() / "film.webp", {64, 64});
        sink.show({Picture(64, 64), true, true, 0});
        EXPECT_THROW(sink.finish(), InputError);
    }
}

TEST(Recorder, AFolderThatCannotBeWrittenIsALine) {
    Recorder recorder(make_film_file("/dev/null/nowhere"));
    recorder.add(Picture(64, 64), 0);
    recorder.stop(1);
    recorder.wait();
    ASSERT_TRUE(recorder.progress().failure);
    EXPECT_NE(recorder.progress().failure->find("/dev/null/nowhere"), std::string::npos);
}

} // namespace
} // namespace framelet
