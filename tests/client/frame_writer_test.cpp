#include "client/frames/frame_writer.h"

#include "client/frames/frame_choice.h"

#include <gtest/gtest.h>

#include <fstream>

#include <unistd.h>

#include "common/error.h"
#include "common/files/image_io.h"

namespace framelet {
namespace {

namespace fs = std::filesystem;

class FrameWriterTest : public testing::Test {
protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("framelet_frames_" + std::to_string(::getpid()) + "_" +
                                               testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::remove_all(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path folder_;
};

Picture grey(std::uint8_t value) {
    Picture out(8, 4);
    std::fill(out.rgba.begin(), out.rgba.end(), value);
    return out;
}

TEST(FramePattern, NumbersFiles) {
    EXPECT_EQ(FramePattern("a/%04d.png").path(7), "a/0007.png");
    EXPECT_EQ(FramePattern("a/%04d.png").path(123456), "a/123456.png");
    EXPECT_EQ(FramePattern("f%d.png").path(12), "f12.png");
    EXPECT_EQ(FramePattern("f%3d.png").path(12), "f 12.png");
    EXPECT_EQ(FramePattern("last.png").path(12), "last.png");
    EXPECT_FALSE(FramePattern("last.png").numbered());
}

TEST(FramePattern, RefusesAllElse) {
    for (char const* const text :
         {"", "%s.png", "%n.png", "%04d%d.png", "%.png", "%04", "%0d.png", "%00d.png", "%12d.png", "%-4d.png", "%%.png",
          "a/%04x.png", "frames", "f.jpg", "%04d", "a.png/"}) {
        EXPECT_THROW(FramePattern{text}, InputError) << text;
    }
}

TEST_F(FrameWriterTest, WritesEveryFrameAndRepeatsThoseThatDidNotChange) {
    FrameWriter writer(FramePattern((folder_ / "deep" / "%02d.png").string()));
    for (int i = 0; i < 30; ++i) {
        writer.add(grey(static_cast<std::uint8_t>(i / 3 * 3)), i % 3 == 0);
    }
    writer.finish();
    for (int i = 0; i < 30; ++i) {
        Picture const picture =
            read_picture(FramePattern((folder_ / "deep" / "%02d.png").string()).path(static_cast<std::uint64_t>(i)));
        EXPECT_EQ(picture.width, 8);
        EXPECT_EQ(picture.rgba[0], i / 3 * 3);
    }
}

TEST_F(FrameWriterTest, LeavesOutWhatIsNotTaken) {
    FramePattern const pattern((folder_ / "%d.png").string());
    FrameWriter writer(pattern);
    for (int i = 0; i < 10; ++i) {
        writer.add(grey(static_cast<std::uint8_t>(i / 4)), i % 4 == 0, i == 1 || i == 3 || i == 6);
    }
    writer.finish();
    for (std::uint64_t i = 0; i < 10; ++i) {
        ASSERT_EQ(fs::exists(pattern.path(i)), i == 1 || i == 3 || i == 6) << i;
        if (fs::exists(pattern.path(i))) {
            EXPECT_EQ(read_picture(pattern.path(i)).rgba[0], i / 4) << i;
        }
    }
}

TEST_F(FrameWriterTest, WritesAtTheEndWhatThereIsRoomForUntilThen) {
    FrameWriter kept(FramePattern((folder_ / "%d.ppm").string()), WhenWritten::at_the_end);
    for (int i = 0; i < 20; ++i) {
        kept.add(grey(static_cast<std::uint8_t>(i)), true);
    }
    EXPECT_TRUE(fs::is_empty(folder_));
    EXPECT_EQ(kept.cpu_seconds(), 0);
    kept.finish();
    for (int i = 0; i < 20; ++i) {
        EXPECT_EQ(read_picture(folder_ / (std::to_string(i) + ".ppm")).rgba[0], i);
    }
}

TEST_F(FrameWriterTest, DoesNotKeepMoreThanThereIsRoomFor) {
    FrameWriter kept(FramePattern((folder_ / "%d.ppm").string()), WhenWritten::at_the_end);
    Picture const large(4096, 4096); // 64 MB
    for (int i = 0; i < 7; ++i) { // the last one waits until some of the first are written
        kept.add(large, true);
    }
    EXPECT_TRUE(fs::exists(folder_ / "0.ppm"));
    kept.finish();
    EXPECT_TRUE(fs::exists(folder_ / "6.ppm"));
}

TEST(FrameChoice, TakesThreeFramesFromEachTimeOn) {
    FrameChoice all({});
    FrameChoice some({0.5, 0.2});
    std::string taken;
    for (int i = 0; i < 10; ++i) {
        EXPECT_TRUE(all.takes(0.1 * i));
        taken += some.takes(0.1 * i + 0.01) ? 'x' : '.';
    }
    EXPECT_EQ(taken, "..xxxxxx..");
}

TEST(FrameChoice, FinishesWhatItHasBegun) {
    FrameChoice choice({0.2, 0.3, 0.7}); // the second comes among the three from the first on
    std::string taken;
    for (int i = 0; i < 10; ++i) {
        taken += choice.takes(0.1 * i + 0.01) ? 'x' : '.';
    }
    EXPECT_EQ(taken, "..xxx..xxx");
}

TEST_F(FrameWriterTest, WithoutANumberKeepsTheLast) {
    FrameWriter writer(FramePattern((folder_ / "only.png").string()));
    writer.add(grey(5), true);
    writer.add(grey(9), true);
    writer.add(grey(9), false);
    writer.finish();
    EXPECT_EQ(read_picture(folder_ / "only.png").rgba[0], 9);
}

TEST_F(FrameWriterTest, SaysThatItCannotWrite) {
    fs::create_directories(folder_);
    std::ofstream(folder_ / "file") << "in the way";
    EXPECT_THROW(FrameWriter(FramePattern((folder_ / "file" / "%d.png").string())), InputError);
    fs::create_directories(folder_ / "0.png");
    FrameWriter writer(FramePattern((folder_ / "%d.png").string()));
    writer.add(grey(1), true);
    EXPECT_THROW(writer.finish(), InputError);
}

} // namespace
} // namespace framelet
