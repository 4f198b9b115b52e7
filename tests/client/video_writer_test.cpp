#include "client/video/video_writer.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include "common/error.h"

namespace framelet {
namespace {

constexpr Viewport size{64, 32};
constexpr std::size_t picture_bytes = 6 + 3 * 64 * 32;

Picture grey(std::uint8_t value) {
    Picture out(size.width, size.height);
    std::fill(out.rgba.begin(), out.rgba.end(), value);
    return out;
}

class Pipe {
public:
    Pipe() { EXPECT_EQ(::pipe2(ends_, O_CLOEXEC), 0); }
    ~Pipe() {
        close_end(0);
        close_end(1);
    }
    Pipe(Pipe const&) = delete;
    Pipe& operator=(Pipe const&) = delete;

    int reading() const { return ends_[0]; }
    int writing() const { return ends_[1]; }
    void close_end(int which) {
        if (ends_[which] >= 0) {
            ::close(std::exchange(ends_[which], -1));
        }
    }
    std::string read_all() const {
        std::string out;
        for (char buffer[4096];;) {
            ssize_t const length = ::read(ends_[0], buffer, sizeof(buffer));
            if (length <= 0) {
                return out;
            }
            out.append(buffer, static_cast<std::size_t>(length));
        }
    }

private:
    int ends_[2] = {-1, -1};
};

/// Luma of the first pixel of each picture behind the header's line.
std::vector<int> lumas(std::string const& video) {
    std::vector<int> out;
    std::size_t const begin = video.find('\n') + 1;
    EXPECT_EQ((video.size() - begin) % picture_bytes, 0u);
    for (std::size_t at = begin; at + picture_bytes <= video.size(); at += picture_bytes) {
        EXPECT_EQ(video.compare(at, 6, "FRAME\n"), 0);
        out.push_back(static_cast<std::uint8_t>(video[at + 6]));
    }
    return out;
}

TEST(VideoWriter, RepeatsAndLeavesOutByTheClock) {
    Pipe pipe;
    auto text = std::async(std::launch::async, [&] { return pipe.read_all(); });
    VideoWriter writer(pipe.writing(), size, PictureRate::of(10), [] { return false; });
    writer.show({grey(0), true, true, 0});
    writer.show({grey(255), true, true, 0.3});
    writer.show({grey(0), true, true, 0.31}); // has no place of its own,
    writer.show({grey(0), false, true, 0.4}); // but is what is seen at the next one
    writer.finish();
    pipe.close_end(1);
    EXPECT_EQ(lumas(text.get()), (std::vector<int>{16, 16, 16, 235, 16}));
    EXPECT_EQ(writer.end_reason(), "");
}

TEST(VideoWriter, NeverWaitsAndKeepsItsLengthWhenNobodyReadsForAWhile) {
    Pipe pipe;
    VideoWriter writer(pipe.writing(), size, PictureRate::of(10), [] { return false; });
    for (int i = 0; i < 100; ++i) { // more than the pipe has room for
        writer.show({grey(static_cast<std::uint8_t>(i)), true, true, 0.1 * i});
    }
    auto text = std::async(std::launch::async, [&] { return pipe.read_all(); });
    writer.finish();
    pipe.close_end(1);
    EXPECT_EQ(lumas(text.get()).size(), 100u);
}

TEST(VideoWriter, AReaderThatGoesIsTheEndAndNoFailure) {
    Pipe pipe;
    VideoWriter writer(pipe.writing(), size, PictureRate::of(10), [] { return false; });
    pipe.close_end(0);
    for (int i = 0; writer.end_reason().empty(); ++i) {
        writer.show({grey(1), true, true, 0.1 * i});
    }
    writer.finish();
    EXPECT_NE(writer.end_reason().find("reads"), std::string::npos);
}

TEST(VideoWriter, OnceToldToEndItWaitsForNoReaderForGood) {
    Pipe pipe;
    std::atomic<bool> is_told = false;
    VideoWriter writer(pipe.writing(), size, PictureRate::of(10), [&is_told] { return is_told.load(); });
    for (int i = 0; i < 100; ++i) { // more than the pipe has room for
        writer.show({grey(static_cast<std::uint8_t>(i)), true, true, 0.1 * i});
    }
    is_told = true;
    writer.finish();
    EXPECT_EQ(writer.end_reason(), "nobody reads the video any more");
}

TEST(VideoWriter, SaysThatItCannotWrite) {
    int const full = ::open("/dev/full", O_WRONLY | O_CLOEXEC);
    ASSERT_GE(full, 0);
    VideoWriter writer(full, size, PictureRate::of(10), [] { return false; });
    EXPECT_THROW(writer.finish(), InputError);
    ::close(full);
}

} // namespace
} // namespace framelet
