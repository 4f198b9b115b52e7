// Tests of the real window by its keys: cameras, screenshots, bookmarks, films.
#include <csignal>
#include <cstring>

#include "client/video/film_writer.h"
#include "tests/launcher/window_session.h"

namespace framelet::test {
namespace {

/// The sections of an MP4 file, in order; the table of its pictures ("moov") is written last, when the film is
/// complete.
std::vector<std::string> sections_of(std::string const& film) {
    std::vector<std::string> out;
    for (std::size_t at = 0; at + 8 <= film.size();) {
        std::size_t length = 0;
        for (std::size_t i = 0; i < 4; ++i) {
            length = length << 8 | static_cast<unsigned char>(film[at + i]);
        }
        out.push_back(film.substr(at + 4, 4));
        if (length < 8) { // it has no length yet
            break;
        }
        at += length;
    }
    return out;
}

TEST_F(WindowTest, TheKeypadLooksAlongAxes) {
    struct View {
        std::string key;
        std::array<double, 3> axis;
    };
    for (View const& view :
         {View{"KP_3", {-1, 0, 0}}, View{"KP_7", {0, -1, 0}}, View{"KP_1", {0, 0, -1}}, View{"ctrl+KP_3", {1, 0, 0}},
          View{"ctrl+KP_7", {0, 1, 0}}, View{"ctrl+KP_1", {0, 0, 1}}}) {
        EXPECT_TRUE(eventually([&] {
            press(view.key);
            press("shift+c");
            return has_looked_along(view.axis);
        })) << view.key;
    }
}

TEST_F(WindowTest, SavesThePictureWithItsDepth) {
    // The lowest line of the picture is the last of the file, and its depths the end of that: there is the ground.
    EXPECT_TRUE(eventually([&] {
        press("shift+F12");
        for (fs::path const& file : saved(".exr")) {
            std::string const bytes = content_of(file);
            std::vector<float> depths(width);
            std::size_t const length = depths.size() * sizeof(float);
            if (bytes.size() < static_cast<std::size_t>(height) * 4 * length) {
                continue; // before the shapes had come, or while it is being written
            }
            std::memcpy(depths.data(), bytes.data() + bytes.size() - length, length);
            if (std::ranges::all_of(depths, [](float depth) { return depth > 1 && depth < 1000; })) {
                return true;
            }
        }
        return false;
    }));
}

TEST_F(WindowTest, TheMouseLooksAroundUntilEscapeEndsThat) {
    EXPECT_TRUE(eventually([&] {
        press("KP_1"); // and no camera of the scene any more
        press("shift+c");
        return has_looked_along({0, 0, -1});
    }));
    nlohmann::json const before = newest_camera();
    nlohmann::json camera;
    EXPECT_TRUE(eventually([&] {
        press("m");
        for (int i = 0; i < 10; ++i) {
            move_mouse(20, 0);
        }
        camera = newest_camera();
        if (camera == before) { // mouse look is off again, where the first key was seen late
            return false;
        }
        press("Escape");
        return true;
    }));
    for (std::size_t i = 0; i < 3; ++i) { // keys that came late may have looked along the axis once more
        EXPECT_NEAR(camera["position"][i].get<double>(), before["position"][i].get<double>(), 1e-3);
        EXPECT_NEAR(camera["up"][i].get<double>(), before["up"][i].get<double>(), 1e-3);
    }
    // The camera looks to the right of -Z.
    EXPECT_GT(camera["target"][0].get<double>() - camera["position"][0].get<double>(), 0.1);
    nlohmann::json const still = newest_camera(); // after Escape, and the window is still there
    move_mouse(-50, 0);
    EXPECT_EQ(newest_camera(), still);
}

TEST_F(WindowTest, EscapeLeavesTheFullScreenAndAsksOnceWhetherToQuit) {
    newest_camera(); // the window hears keys
    press("F11");
    input({"key", "Escape"});
    std::this_thread::sleep_for(2s);
    input({"key", "Escape"});
    std::this_thread::sleep_for(2s);
    newest_camera(); // it is still there
    EXPECT_TRUE(eventually([&] {
        input({"key", "--delay", "300", "Escape", "Escape"});
        return !program_->running();
    }));
    EXPECT_EQ(program_->wait(patience), 0) << program_->errors();
    EXPECT_FALSE(nlohmann::json::parse(memory()).at("fullscreen").get<bool>());
}

TEST_F(WindowTest, GoesToTheViewThatWasCopiedAndToThatOfTheCommandLine) {
    auto const is_at = [](nlohmann::json const& camera, nlohmann::json const& wanted) {
        for (char const* const part : {"position", "target"}) {
            for (std::size_t i = 0; i < 3; ++i) {
                if (std::abs(camera[part][i].get<double>() - wanted[part][i].get<double>()) > 1e-3) {
                    return false;
                }
            }
        }
        return camera["exposure"] == wanted["exposure"] && camera["scene_time"] == wanted["scene_time"];
    };
    nlohmann::json const copied = newest_camera();
    EXPECT_TRUE(copied.at("paused").get<bool>());
    press("c");
    EXPECT_TRUE(eventually([&] {
        press("KP_7");
        press("bracketright");
        return !is_at(newest_camera(), copied);
    }));
    EXPECT_TRUE(eventually([&] {
        press("v");
        return is_at(newest_camera(), copied);
    }));
    nlohmann::json const given{
        {"position", {1, 20, 3}}, {"target", {1, 19, 3}}, {"up", {0, 0, -1}}, {"scene_time", 1.25}, {"exposure", 0.5}};
    std::string const file = folder_.write("given.json", given.dump());
    start(FRAMELET_VIEWER, {server_->address(), "--size", "320x200", "--camera", file});
    EXPECT_TRUE(eventually([&] { return is_at(newest_camera(), given); }));
}

TEST_F(WindowTest, KeepsBookmarksForTheSceneFile) {
    fs::path const folder = folder_.path() / "framelet" / "cameras";
    std::string name;
    EXPECT_TRUE(eventually([&] {
        press("b");
        if (!fs::exists(folder)) {
            return false;
        }
        name = fs::directory_iterator(folder)->path().filename().string();
        return name.ends_with(".json");
    }));
    EXPECT_TRUE(name.starts_with("windmill-")) << name;
    EXPECT_EQ(name.size(), std::string("windmill-0123456789abcdef.json").size()) << name;
}

TEST_F(WindowTest, ASignalFinishesTheFilmAndKeepsTheSettings) {
    if (!can_write_film("film.mp4")) {
        GTEST_SKIP() << "this build writes no films";
    }
    for (int const number : {SIGTERM, SIGINT, SIGHUP}) {
        std::size_t const before = saved(".mp4").size();
        EXPECT_TRUE(eventually([&] { // a key that comes before the first picture does nothing
            press("F9");
            std::this_thread::sleep_for(std::chrono::seconds(2));
            return saved(".mp4").size() > before;
        }));
        EXPECT_FALSE(has(program_->errors(), "saved")) << "it is still being recorded: " << program_->errors();
        program_->signal(number);
        EXPECT_EQ(program_->wait(patience), 0) << program_->errors();
        EXPECT_TRUE(has(program_->errors(), "framelet-viewer: saved ")) << program_->errors();
        for (fs::path const& film : saved(".mp4")) {
            EXPECT_EQ(sections_of(content_of(film)).back(), "moov") << film;
        }
        EXPECT_TRUE(has(memory(), server_->address())) << memory();
        start(FRAMELET_VIEWER, {server_->address(), "--size", "320x200"});
        fs::remove(folder_.path() / "framelet" / "viewer.json");
    }
}

/// OpenGL paints what moves here, also where it is a program on the processor.
class PaintedWindowTest : public WindowTest {
protected:
    PaintedWindowTest() {
        server_options_ = {"--insecure"};
        painter_ = "gpu";
    }
};

TEST_F(PaintedWindowTest, SavesWhatTheGraphicsCardHasPainted) {
    EXPECT_TRUE(eventually([&] {
        press("shift+F12");
        for (fs::path const& file : saved(".exr")) {
            // The picture's last line: blue, green, red, depth.
            std::string const bytes = content_of(file);
            std::vector<float> line(4 * width);
            std::size_t const length = line.size() * sizeof(float);
            if (bytes.size() < static_cast<std::size_t>(height) * length) {
                continue;
            }
            std::memcpy(line.data(), bytes.data() + bytes.size() - length, length);
            if (std::all_of(line.end() - width, line.end(), [](float depth) { return depth > 1 && depth < 1000; }) &&
                std::all_of(line.begin(), line.end() - width, [](float light) { return light > 0 && light <= 1; })) {
                return true;
            }
        }
        return false;
    }));
    EXPECT_EQ(program_->errors().find("processor paints"), std::string::npos) << program_->errors();
}

} // namespace
} // namespace framelet::test
