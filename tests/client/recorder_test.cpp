#include "client/window/kept/recorder.h"

#include <condition_variable>
#include <fstream>

#include <gtest/gtest.h>

#include "common/error.h"
#include "tests/client/own_folder.h"

namespace framelet {
namespace {

/// What a writer was given, and a way to keep it busy.
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
    Recorder recorder(std::make_unique<LoggingWriter>(log));
    recorder.add(Picture(1, 1), 0);
    log.wait([&] { return log.added.size() == 1; }); // the writer has it, the queue is empty
    for (int i = 0; i < 20; ++i) {
        recorder.add(Picture(2 + i, 1), 1 + i);
    }
    Recorder::Progress const progress = recorder.progress();
    EXPECT_EQ(progress.pictures, 1 + Recorder::most_waiting);
    EXPECT_EQ(progress.left_out, 20 - Recorder::most_waiting);
    EXPECT_EQ(progress.seconds, 20);
    EXPECT_NE(progress_text(progress).find("14 left out"), std::string::npos);
    log.release();
    log.wait([&] { return log.added.size() == 1 + Recorder::most_waiting; });
    EXPECT_EQ(log.added[1], std::pair(2, 1.0));
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
    Recorder recorder(make_film_writer(folder.path()));
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

TEST(Recorder, AFolderThatCannotBeWrittenIsALine) {
    Recorder recorder(make_film_writer("/dev/null/nowhere"));
    recorder.add(Picture(64, 64), 0);
    recorder.stop(1);
    recorder.wait();
    ASSERT_TRUE(recorder.progress().failure);
    EXPECT_NE(recorder.progress().failure->find("/dev/null/nowhere"), std::string::npos);
}

} // namespace
} // namespace framelet
