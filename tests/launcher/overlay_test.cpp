// A test of what lies over the picture, in a window of this process.
#include "client/window/overlay/overlay.h"

#include <optional>

#include <imgui.h>

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

class ServerFields : public OverlayTest {
protected:
    void SetUp() override {
        OverlayTest::SetUp();
        if (IsSkipped()) {
            return;
        }
        window_.emplace("overlay", Viewport{640, 480});
        window_->show();
        overlay_.emplace(window_->handle());
        content_.message = "a message";
        content_.address = {"localhost:7070", {}, ServerField::address};
    }
    OverlayActions draw() {
        OverlayActions out;
        for (int i = 0; i < 3; ++i) {
            window_->draw_picture();
            out = overlay_->draw(content_, 1);
            window_->present();
        }
        return out;
    }
    void type(char const* text) {
        draw();
        ImGui::GetIO().AddInputCharactersUTF8(text);
        draw();
    }

    std::optional<Window> window_;
    std::optional<Overlay> overlay_;
    OverlayContent content_;
};

TEST_F(ServerFields, KeepWhatWasTypedWhileAQuestionIsAsked) {
    type("tls://localhost:7272");
    content_.address->takes_keys = ServerField::token;
    type("a token");
    OverlayContent const asked_before = content_;
    content_.address.reset();
    content_.asks_trust = true;
    draw();
    content_ = asked_before;
    draw();
    EXPECT_EQ(overlay_->server().address, "tls://localhost:7272");
    EXPECT_EQ(overlay_->server().token, "a token");
    content_.address.reset(); // a session, which is lost again
    draw();
    content_.address = {"elsewhere:1", {}};
    draw();
    EXPECT_EQ(overlay_->server().address, "elsewhere:1");
    EXPECT_EQ(overlay_->server().token, "");
}

TEST_F(ServerFields, TheFieldAtFaultTakesTheKeysOnce) {
    draw();
    EXPECT_TRUE(overlay_->is_typed_into());
    content_.address->takes_keys = ServerField::token;
    type("secret");
    EXPECT_EQ(overlay_->server().address, "localhost:7070");
    EXPECT_EQ(overlay_->server().token, "secret");
    type(" words");
    EXPECT_EQ(overlay_->server().token, "secret words") << "what is typed is not chosen again";
}

TEST_F(OverlayTest, TheBarHasNoControlsOfAClockThatMovesNothing) {
    Window window("overlay", {640, 480});
    window.show();
    Overlay overlay(window.handle());
    OverlayContent content;
    content.cameras.current = free_camera_text;
    bool acts = false;
    auto const draw = [&] {
        for (int i = 0; i < 3; ++i) {
            window.wait(0.02);
            window.draw_picture();
            OverlayActions const asked = overlay.draw(content, 1);
            window.present();
            acts = acts || asked.seek || !asked.commands.empty();
        }
    };
    auto const acts_where_the_clock_is = [&](double duration) {
        content.time_line = TimeLine{{}, duration};
        acts = false;
        for (int x = 110; x < 240; x += 10) {
            input({"mousemove", std::to_string(x), "460", "sleep", "0.05", "mousedown", "1"});
            draw();
            input({"mouseup", "1"});
            draw();
        }
        return acts;
    };
    EXPECT_TRUE(acts_where_the_clock_is(4));
    EXPECT_FALSE(acts_where_the_clock_is(0));
}

} // namespace
} // namespace framelet::test
