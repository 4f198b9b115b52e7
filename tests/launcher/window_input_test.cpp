// Tests of the real window by its mouse: what is under the pointer, the bar, the window's own size; and of what goes on
// in it for longer.
#include <csignal>
#include <sstream>

#include <glm/geometric.hpp>

#include "client/core/camera/camera_path.h"
#include "tests/launcher/window_session.h"
#include "tests/loopback/metrics_page.h"

namespace framelet::test {
namespace {

/// A place in the window where the first view shows a house, beside its middle.
constexpr Vec2 on_house{90, 140};

struct Ray {
    Vec3 from, way; ///< `way` has the length 1
};

Ray ray_through(Camera const& camera, Vec2 place) {
    ViewRays const rays = make_view_rays(camera, {width, height});
    return {rays.origin + place.x * rays.origin_dx + place.y * rays.origin_dy,
            glm::normalize(rays.direction + place.x * rays.direction_dx + place.y * rays.direction_dy)};
}

/// The place where two rays meet: the way to it on each, metres. Nothing where they do not, by more than what a pixel
/// makes.
std::optional<std::pair<float, float>> meeting(Ray const& a, Ray const& b) {
    Vec3 const apart = b.from - a.from;
    float const along = glm::dot(a.way, b.way);
    float const sine_squared = 1 - along * along;
    if (sine_squared < 1e-4f) {
        return std::nullopt;
    }
    float const on_a = (glm::dot(apart, a.way) - along * glm::dot(apart, b.way)) / sine_squared;
    float const on_b = along * on_a - glm::dot(apart, b.way);
    float const gap = glm::distance(a.from + on_a * a.way, b.from + on_b * b.way);
    bool const meet = on_a > 0 && on_b > 0 && gap < 0.01f * on_a;
    return meet ? std::optional(std::pair(on_a, on_b)) : std::nullopt;
}

/// The mean difference of colours between two parts of pictures, each the upper left one of this size, that show the
/// same but for their size, and of the upper two thirds, where there is no bar.
double difference(Picture const& a, Viewport a_size, Picture const& b, Viewport b_size) {
    constexpr int steps = 30;
    double sum = 0;
    for (int j = 1; j < steps; ++j) {
        for (int i = 1; i < steps; ++i) {
            auto const pixel = [&](Picture const& picture, Viewport size) {
                return picture.row(size.height * j * 2 / (3 * steps)) + std::ptrdiff_t{4} * (size.width * i / steps);
            };
            for (int k = 0; k < 3; ++k) {
                sum += std::abs(pixel(a, a_size)[k] - pixel(b, b_size)[k]);
            }
        }
    }
    return sum / (3 * (steps - 1) * (steps - 1));
}

class WindowInputTest : public WindowTest {
protected:
    Camera camera() { return parse_camera_path(newest_camera().dump(), "what was saved").at(0); }

    static std::vector<std::string> at(Vec2 place, std::vector<std::string> const& words) {
        std::vector<std::string> out{"mousemove", std::to_string(static_cast<int>(place.x)),
                                     std::to_string(static_cast<int>(place.y))};
        out.insert(out.end(), words.begin(), words.end());
        return out;
    }
    static void drag(Vec2 from, Vec2 to) {
        input(at(from, {"sleep", "0.1", "mousedown", "1", "sleep", "0.1"}));
        input(at((from + to) / 2.0f, {"sleep", "0.1"}));
        input(at(to, {"sleep", "0.1", "mouseup", "1"}));
    }

    static void double_click(Vec2 place) { input(at(place, {"click", "--repeat", "2", "--delay", "50", "1"})); }

    /// Does something by hand to the first view, until what it did to the camera is as it should be: before there is a
    /// picture nothing is known to be under the pointer. Gives the camera after it.
    Camera expect_of_camera(std::function<void()> const& act,
                            std::function<bool(Camera const&, Camera const&)> const& is) {
        Camera before, after;
        EXPECT_TRUE(eventually([&] {
            press("r");
            before = camera();
            act();
            after = camera();
            return is(before, after);
        })) << before.position.x
            << ' ' << before.position.y << ' ' << before.position.z << " to " << after.position.x << ' '
            << after.position.y << ' ' << after.position.z;
        return after;
    }

    /// Stops the server once there is a picture, so that nothing more comes, and gives what is on the screen then.
    Picture screen_at_rest() {
        Picture const black(640, 480); // as the screen is before there is a window
        EXPECT_TRUE(eventually([&] { return difference(black, size_, screen(), size_) > 20; }));
        server_->process().signal(SIGSTOP);
        Picture out;
        EXPECT_TRUE(eventually([&] {
            out = screen();
            std::this_thread::sleep_for(500ms);
            return screen() == out;
        }));
        return out;
    }

    /// The time of the scene's clock, as another viewer sees it.
    double scene_seconds() {
        fs::path const file = folder_.path() / "frames.jsonl";
        Process client(FRAMELET_CLIENT, {server_->address(), "--size", "32x32", "--duration", "0.2", "--frames", file});
        EXPECT_EQ(client.wait(patience), 0) << client.errors();
        std::istringstream lines(content_of(file));
        std::string last;
        for (std::string line; std::getline(lines, line);) {
            last = line;
        }
        return nlohmann::json::parse(last).at("scene_seconds").get<double>();
    }
};

TEST_F(WindowInputTest, ADragOrbitsAroundWhatIsUnderThePointer) {
    expect_of_camera([] { drag(on_house, on_house + Vec2(40, 0)); },
                     [](Camera const& before, Camera const& after) {
                         auto const met = meeting(ray_through(before, on_house), ray_through(after, on_house));
                         return met && std::abs(met->first - met->second) < 0.01f * met->first;
                     });
}

TEST_F(WindowInputTest, ADoubleClickGoesHalfOfTheWayThere) {
    float half = 0;
    Camera const there = expect_of_camera([] { double_click(on_house); },
                                          [&](Camera const& before, Camera const& after) {
                                              Vec3 const way = after.position - before.position;
                                              Vec3 const looked = ray_through(before, on_house).way;
                                              half = glm::length(way);
                                              return half > 1 && glm::dot(way, looked) > 0.9998f * half &&
                                                     glm::dot(after.forward(), looked) > 0.9998f;
                                          });
    double_click({width / 2, height / 2}); // where the same is seen now
    Camera nearer;
    EXPECT_TRUE(eventually([&] {
        nearer = camera();
        return nearer.position != there.position;
    }));
    EXPECT_NEAR(glm::distance(nearer.position, there.position), half / 2, 0.1f * half);
}

TEST_F(WindowInputTest, TheWheelGoesTowardsWhatIsUnderThePointer) {
    expect_of_camera(
        [] {
            input(at(on_house, {"click", "4"}));
        },
        [](Camera const& before, Camera const& after) {
            Vec3 const way = after.position - before.position;
            return glm::length(way) > 1e-3f && glm::dot(before.forward(), after.forward()) > 0.99999f &&
                   glm::dot(glm::normalize(way), ray_through(before, on_house).way) > 0.9998f;
        });
}

TEST_F(WindowInputTest, TheBarSetsTheClock) {
    constexpr float bar = height - 17;
    constexpr Vec2 play{175, bar};
    auto const scrub_to = [&](float x) { drag({x - 10, bar}, {x, bar}); };
    double later = 0;
    EXPECT_TRUE(eventually([&] {
        scrub_to(280);
        later = scene_seconds();
        return later > 0;
    }));
    EXPECT_TRUE(eventually([&] {
        scrub_to(250);
        double const earlier = scene_seconds();
        return earlier > 0 && earlier < later;
    }));
    double const still = scene_seconds();
    EXPECT_EQ(scene_seconds(), still) << "the clock stands";
    EXPECT_TRUE(eventually([&] {
        input(at(play, {"sleep", "0.1", "click", "1"}));
        return soon([&] { return scene_seconds() != still; });
    }));
}

TEST_F(WindowInputTest, WhatWasSetByHandIsThereTheNextTime) {
    struct Kept {
        float exposure = 0, bias = 0;
    };
    auto const change_and_quit = [&] {
        newest_camera(); // the window hears keys
        press("bracketright");
        press("l");
        input({"key", "ctrl+q"});
        EXPECT_EQ(program_->wait(patience), 0) << program_->errors();
        Kept out;
        fs::path const folder = folder_.path() / "framelet";
        out.bias = nlohmann::json::parse(content_of(folder / "viewer.json")).at("bias").get<float>();
        for (auto const& entry : fs::directory_iterator(folder / "scenes")) {
            out.exposure = nlohmann::json::parse(content_of(entry.path())).at("exposure").get<float>();
        }
        return out;
    };
    Kept const first = change_and_quit();
    EXPECT_GT(first.exposure, 0);
    EXPECT_GT(first.bias, 0);
    start_viewer();
    Kept const second = change_and_quit();
    EXPECT_GT(second.exposure, first.exposure) << "it went on from there";
    EXPECT_GT(second.bias, first.bias);
}

TEST_F(WindowInputTest, AnotherSizeKeepsThePicture) {
    constexpr Viewport after{480, 300};
    Picture const shown = screen_at_rest();
    input({"search", "--name", "framelet-viewer", "windowsize", "480", "300"});
    EXPECT_TRUE(eventually([&] { return difference(shown, size_, screen(), after) < 10; }));
    server_->process().signal(SIGCONT);
    EXPECT_TRUE(eventually([&] {
        press("F12");
        return std::ranges::any_of(saved(".png"), [](fs::path const& file) {
            std::string const content = content_of(file); // which may be none yet
            return content.size() > 24 &&
                   content.substr(16, 8) == std::string("\0\0\x01\xe0\0\0\x01\x2c", 8); // 480 and 300
        });
    })) << "what comes for the new size is shown";
}

/// The bar has room for all of its parts.
class WideWindowTest : public WindowInputTest {
protected:
    WideWindowTest() { size_ = {640, 240}; }
};

TEST_F(WideWindowTest, TheListSaysWhatIsDrawnOverThePicture) {
    constexpr Vec2 list{424, 223};
    constexpr float to_none = 109, to_confidence = 75; // from the list up to what it holds
    auto const choose = [&](float above) {
        input(at(list, {"sleep", "0.2", "click", "1", "sleep", "0.3"}));
        input(at(list - Vec2(0, above), {"sleep", "0.2", "click", "1"}));
    };
    Picture const plain = screen_at_rest();
    EXPECT_TRUE(eventually([&] {
        choose(to_confidence);
        return soon([&] { return difference(plain, size_, screen(), size_) > 20; });
    })) << "grey, washed with colours";
    EXPECT_TRUE(eventually([&] {
        choose(to_none);
        return soon([&] { return difference(plain, size_, screen(), size_) < 10; });
    }));
}

/// The scene moves, and the server says how many rays it renders.
class MovingWindowTest : public WindowInputTest {
protected:
    MovingWindowTest() { server_options_ = {"--insecure", "--metrics", "0"}; }

    double rays() { return metric(ask(metrics_address(*server_), "/metrics").body(), "framelet_rays_total"); }
    bool has_grown_since(double rays_then) {
        return eventually([&] { return rays() > rays_then; });
    }
};

TEST_F(MovingWindowTest, AFilmIsThereOnceItIsSaidToBe) {
    EXPECT_TRUE(eventually([&] { // begins it, then ends it
        press("F9");
        return soon([&] { return program_->errors().find("framelet-viewer: saved ") != std::string::npos; });
    })) << program_->errors();
    std::string const errors = program_->errors();
    std::size_t const begin = errors.find("saved ") + 6;
    fs::path const film = errors.substr(begin, errors.find(": ", begin) - begin);
    EXPECT_EQ(film.parent_path(), folder_.path());
    EXPECT_TRUE(fs::is_directory(film) ? !fs::is_empty(film) : fs::file_size(film) > 1000) << errors;
    EXPECT_EQ(errors.find(" 0 pictures"), std::string::npos) << errors;
}

TEST_F(MovingWindowTest, NothingIsRenderedForAWindowThatIsHidden) {
    newest_camera();
    EXPECT_TRUE(has_grown_since(0));
    EXPECT_TRUE(has_grown_since(rays()));
    input({"search", "--name", "framelet-viewer", "windowunmap"});
    double hidden = 0;
    EXPECT_TRUE(eventually([&] {
        hidden = rays();
        for (int i = 0; i < 5; ++i) {
            std::this_thread::sleep_for(200ms);
            if (rays() != hidden) {
                return false;
            }
        }
        return true;
    })) << "batches go on";
    input({"search", "--name", "framelet-viewer", "windowmap"});
    EXPECT_TRUE(has_grown_since(hidden)) << "it goes on";
    EXPECT_TRUE(program_->running()) << program_->errors();
}

} // namespace
} // namespace framelet::test
