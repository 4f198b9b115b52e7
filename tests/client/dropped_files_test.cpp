#include "client/window/dropped_files.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(DroppedFiles, CamerasAreToldFromScenes) {
    using Names = std::vector<std::string>;
    DroppedFiles const sorted = sort_dropped({"/a/b.glb", "/a/view.camera.JSON", "/a.json/c", "d.json", ".json"});
    EXPECT_EQ(sorted.scenes, (Names{"/a/b.glb", "/a.json/c", ".json"}));
    EXPECT_EQ(sorted.cameras, (Names{"/a/view.camera.JSON", "d.json"}));
    EXPECT_TRUE(sort_dropped({}).scenes.empty());
}

} // namespace
} // namespace framelet
