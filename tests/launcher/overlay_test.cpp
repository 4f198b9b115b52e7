// A test of what lies over the picture, in a window of this process.
#include "client/window/overlay/overlay.h"

#include "client/window/window.h"
#include "tests/launcher/window_fixture.h"

namespace framelet::test {
namespace {

using OverlayTest = WindowFixture;

TEST_F(OverlayTest, FollowsTheScaleOfTheScreen) {
    Window window("overlay", {1280, 960});
    window.show();
    Overlay overlay(window.handle());
    OverlayContent content;
    content.message = "a message";
    content.address = {"localhost", {}};
    auto const panel_width = [&](float scale) {
        for (int i = 0; i < 3; ++i) {
            window.draw_picture();
            overlay.draw(content, scale);
            window.present();
        }
        EXPECT_EQ(overlay.mouse_areas().size(), 1u);
        return overlay.mouse_areas().front().width();
    };
    int const width = panel_width(1);
    EXPECT_GT(width, 200);
    EXPECT_NEAR(panel_width(2), 2 * width, 4);
    EXPECT_EQ(panel_width(1), width);
}

} // namespace
} // namespace framelet::test
