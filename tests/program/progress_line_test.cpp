// Tests the line that shows how far loading is.
#include "server/program/progress_line.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(ProgressLine, SaysWhatHowFarAndForHowLong) {
    EXPECT_EQ(progress_line("reading", 0, 0), "reading                  [                ]   0%  0.0 s");
    EXPECT_EQ(progress_line("images", 0.5, 0.94), "images                   [########        ]  50%  0.9 s");
    EXPECT_EQ(progress_line("images", 1, 0.25), "images                   [################] 100%  0.2 s");
}

TEST(ProgressLine, SaysHowLongItWillTakeYetAfterTheFirstSecond) {
    EXPECT_EQ(progress_line("meshes", 0.25, 2), "meshes                   [####            ]  25%  2.0 s, 6.0 s left");
    EXPECT_EQ(progress_line("meshes", 0.5, 90),
              "meshes                   [########        ]  50%  1 min 30 s, 1 min 30 s left");
    EXPECT_EQ(progress_line("meshes", 0.1, 1000),
              "meshes                   [#               ]  10%  16 min 40 s, 2 h 30 min left");
    EXPECT_EQ(progress_line("meshes", 0, 2), "meshes                   [                ]   0%  2.0 s")
        << "there is nothing to judge by";
    EXPECT_EQ(progress_line("meshes", 1, 2), "meshes                   [################] 100%  2.0 s");
}

TEST(ProgressLine, FitsATerminal) {
    std::string const line = progress_line("images (a-model-with-a-long-name.glb)", 0.0101, 3599);
    EXPECT_EQ(line, "images (a-model-with-a-l [                ]   1%  59 min 59 s, 97 h 58 min left");
    EXPECT_LE(line.size(), 80u);
    std::string name, columns;
    for (int i = 0; i < 30; ++i) {
        name += "\xc3\xa4"; // one letter
        columns += i < 24 ? "\xc3\xa4" : "";
    }
    EXPECT_TRUE(progress_line(name, 0, 0).starts_with(columns + " [")) << "it is cut between letters";
}

TEST(ProgressLine, TakesTheNearestFraction) {
    EXPECT_EQ(progress_line("light", -1, 0), progress_line("light", 0, 0));
    EXPECT_EQ(progress_line("light", 1.5, 2), progress_line("light", 1, 2));
}

} // namespace
} // namespace framelet
