#include "client/window/window.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <utility>

#include <epoxy/gl.h>

#include <GLFW/glfw3.h>
#include <glm/geometric.hpp>

#include "client/viewer/commands.h"
#include "client/window/gamepad.h"
#include "client/window/picture_texture.h"
#include "client/window/screen_choice.h"
#include "common/error.h"

namespace framelet {

namespace {

/// Time between two looks at a gamepad that is connected, which wakes nobody; seconds.
constexpr double gamepad_seconds = 1.0 / 60;
constexpr double double_click_seconds = 0.4;
constexpr float double_click_pixels = 6;

std::string last_glfw_error() {
    char const* text = nullptr;
    glfwGetError(&text);
    return text == nullptr ? "no reason given" : text;
}

/// The key as it is labelled: letters with Ctrl, other than those that fly, are not told by where they lie. Ctrl+A on a
/// French keyboard is where Ctrl+Q is on others.
int labelled_key(int code, int scancode) {
    char const* const name = glfwGetKeyName(code, scancode);
    bool const is_letter = name != nullptr && name[0] >= 'a' && name[0] <= 'z' && name[1] == '\0';
    return is_letter ? GLFW_KEY_A + (name[0] - 'a') : code;
}

/// The axes of the first gamepad; nothing where none is connected.
std::optional<GamepadAxes> read_gamepad() {
    GLFWgamepadstate state;
    for (int number = GLFW_JOYSTICK_1; number <= GLFW_JOYSTICK_LAST; ++number) {
        if (glfwJoystickIsGamepad(number) == GLFW_TRUE && glfwGetGamepadState(number, &state) == GLFW_TRUE) {
            return GamepadAxes{{state.axes[GLFW_GAMEPAD_AXIS_LEFT_X], state.axes[GLFW_GAMEPAD_AXIS_LEFT_Y]},
                               {state.axes[GLFW_GAMEPAD_AXIS_RIGHT_X], state.axes[GLFW_GAMEPAD_AXIS_RIGHT_Y]},
                               state.axes[GLFW_GAMEPAD_AXIS_LEFT_TRIGGER],
                               state.axes[GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER],
                               state.buttons[GLFW_GAMEPAD_BUTTON_LEFT_BUMPER] == GLFW_PRESS ||
                                   state.buttons[GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER] == GLFW_PRESS};
        }
    }
    return {};
}

/// Guards what `wake` asks of GLFW: its thread may outlive the window, as that of an attempt to connect does which was
/// given up.
std::mutex wake_mutex;
bool can_wake = false;

void set_can_wake(bool can) {
    std::lock_guard const lock(wake_mutex);
    can_wake = can;
}

/// Has GLFW initialised for as long as it lives.
struct GlfwSession {
    GlfwSession() {
        if (glfwInit() != GLFW_TRUE) {
            throw InputError("cannot open a window: there is no display (" + last_glfw_error() +
                             "): use framelet-client, which needs none");
        }
        set_can_wake(true);
    }
    ~GlfwSession() {
        set_can_wake(false);
        glfwTerminate();
    }
    GlfwSession(GlfwSession const&) = delete;
    GlfwSession& operator=(GlfwSession const&) = delete;
};

} // namespace

struct Window::Impl {
    GlfwSession session;
    GLFWwindow* window = nullptr;
    std::optional<PictureTexture> texture;
    WindowInput input;
    Vec2 cursor{0, 0}; ///< pixels of the framebuffer
    bool zooms = false; ///< the wheel has turned since the pointer moved
    Vec2 click{0, 0}; ///< where the left button was pressed last
    double click_time = -1; ///< when that was; < 0: what comes next is no double click
    std::vector<PixelRect> overlay; ///< areas of the overlay
    bool is_typing = false;
    bool looks = false; ///< the mouse turns the head
    bool begins_to_look = false; ///< it has not been moved since it began to
    bool overlay_drag = false; ///< a button was pressed in the overlay
    bool has_gamepad = false;
    Viewport size;
    struct {
        int x = 0, y = 0, width = 0, height = 0;
    } windowed; ///< place and size to go back to from the full screen

    ~Impl() {
        texture.reset(); // while there is a context
        if (window != nullptr) {
            glfwDestroyWindow(window);
        }
    }

    static Impl& of(GLFWwindow* window) { return *static_cast<Impl*>(glfwGetWindowUserPointer(window)); }
    bool held(int key) const { return glfwGetKey(window, key) == GLFW_PRESS; }
    bool button(int number) const { return glfwGetMouseButton(window, number) == GLFW_PRESS; }
    bool shift() const { return held(GLFW_KEY_LEFT_SHIFT) || held(GLFW_KEY_RIGHT_SHIFT); }

    void key(int code, int scancode, int action, int mods) {
        if (action == GLFW_RELEASE) {
            return;
        }
        KeyModifiers const with{(mods & GLFW_MOD_SHIFT) != 0, (mods & GLFW_MOD_CONTROL) != 0,
                                (mods & GLFW_MOD_ALT) != 0};
        auto const command =
            command_of_key(with.control ? labelled_key(code, scancode) : code, with, action == GLFW_REPEAT);
        input.touched_overlay = input.touched_overlay || is_typing;
        if (command && (!is_typing || command == Command::quit || command == Command::open_file)) {
            input.commands.push_back(*command);
        }
    }

    /// The pointer's position, pixels of the framebuffer.
    Vec2 pointer() const {
        double x = 0;
        double y = 0;
        glfwGetCursorPos(window, &x, &y);
        int width = 1;
        int height = 1;
        glfwGetWindowSize(window, &width, &height);
        return Vec2(x, y) * (static_cast<float>(size.width) / static_cast<float>(std::max(width, 1)));
    }

    void cursor_moved() {
        Vec2 const place = pointer();
        Vec2 const way = place - cursor;
        cursor = place;
        zooms = false;
        if (looks) { // the first way may be one from outside of the window
            input.look += std::exchange(begins_to_look, false) ? Vec2(0, 0) : way;
            return;
        }
        touch_overlay(is_over_overlay(place - way));
        if (overlay_drag) {
            return;
        }
        if (button(GLFW_MOUSE_BUTTON_MIDDLE) || (button(GLFW_MOUSE_BUTTON_LEFT) && shift())) {
            input.pan += way;
        } else if (button(GLFW_MOUSE_BUTTON_LEFT)) {
            input.orbit += way;
        } else if (button(GLFW_MOUSE_BUTTON_RIGHT) && held_direction() != Vec3(0, 0, 0)) {
            input.look += way; // as in most games' editors
        } else if (button(GLFW_MOUSE_BUTTON_RIGHT)) {
            constexpr float steps_per_height = 30;
            input.dolly += -way.y * steps_per_height / static_cast<float>(size.height);
        }
    }

    bool is_over_overlay(Vec2 place) const {
        return std::ranges::any_of(overlay, [place](PixelRect const& area) {
            return place.x >= static_cast<float>(area.left) && place.x < static_cast<float>(area.right) &&
                   place.y >= static_cast<float>(area.top) && place.y < static_cast<float>(area.bottom);
        });
    }
    void touch_overlay(bool was_there = false) {
        input.touched_overlay = input.touched_overlay || overlay_drag || was_there || is_over_overlay(cursor);
    }
    bool any_button() const {
        return button(GLFW_MOUSE_BUTTON_LEFT) || button(GLFW_MOUSE_BUTTON_RIGHT) || button(GLFW_MOUSE_BUTTON_MIDDLE);
    }

    void released() {
        touch_overlay();
        overlay_drag = overlay_drag && any_button();
    }

    void pressed(int number) {
        if (looks) {
            input.commands.push_back(Command::mouse_look);
            return;
        }
        cursor = pointer(); // a drag starts here
        overlay_drag = overlay_drag || is_over_overlay(cursor);
        touch_overlay();
        if (overlay_drag) {
            return;
        }
        zooms = false;
        double const now = glfwGetTime();
        bool const left = number == GLFW_MOUSE_BUTTON_LEFT;
        if (left && now - click_time < double_click_seconds && glm::distance(cursor, click) < double_click_pixels) {
            input.focused = cursor;
            click_time = -1;
            return;
        }
        input.grabbed = cursor;
        click = cursor;
        click_time = left ? now : -1;
    }

    void scrolled(float steps) {
        if (looks) {
            input.speed += steps;
            return;
        }
        cursor = pointer();
        if (is_over_overlay(cursor)) {
            touch_overlay();
            return;
        }
        if (!std::exchange(zooms, true)) {
            input.grabbed = cursor;
        }
        input.dolly += steps;
    }

    void read_size() {
        int width = 0;
        int height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        if (width > 0 && height > 0) {
            size = {std::min(width, max_viewport_side), std::min(height, max_viewport_side)};
        }
        input.redraw = true;
    }

    /// The screen that has most of the window; null where there is none.
    GLFWmonitor* monitor() const {
        int count = 0;
        GLFWmonitor** const monitors = glfwGetMonitors(&count);
        std::vector<PixelRect> screens;
        for (int i = 0; i < count; ++i) {
            int x = 0;
            int y = 0;
            glfwGetMonitorPos(monitors[i], &x, &y);
            GLFWvidmode const* const mode = glfwGetVideoMode(monitors[i]);
            screens.push_back(mode == nullptr ? PixelRect{} : PixelRect{x, y, x + mode->width, y + mode->height});
        }
        int x = 0;
        int y = 0;
        int width = 0;
        int height = 0;
        glfwGetWindowPos(window, &x, &y);
        glfwGetWindowSize(window, &width, &height);
        return count == 0 ? nullptr : monitors[screen_of({x, y, x + width, y + height}, screens)];
    }

    Vec3 held_direction() const {
        if (is_typing) {
            return {0, 0, 0};
        }
        auto const axis = [&](int more, int less) {
            return static_cast<float>(held(more) ? 1 : 0) - static_cast<float>(held(less) ? 1 : 0);
        };
        return {axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q), axis(GLFW_KEY_S, GLFW_KEY_W)};
    }

    void read_held_keys() {
        input.fly.direction = held_direction();
        input.fly.fast = !is_typing && shift();
    }

    /// Adds what the gamepad asks for, if this window has the keys: other windows may be flown by it.
    void add_gamepad() {
        bool const has_keys = glfwGetWindowAttrib(window, GLFW_FOCUSED) != 0;
        std::optional<GamepadAxes> const axes = has_keys ? read_gamepad() : std::nullopt;
        has_gamepad = axes.has_value();
        if (axes) {
            input.fly = input.fly + fly_input(*axes);
        }
    }

    void listen() {
        glfwSetWindowUserPointer(window, this);
        glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int scancode, int action, int mods) {
            of(w).key(key, scancode, action, mods);
        });
        glfwSetCursorPosCallback(window, [](GLFWwindow* w, double, double) { of(w).cursor_moved(); });
        glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int number, int action, int) {
            action == GLFW_PRESS ? of(w).pressed(number) : of(w).released();
        });
        glfwSetScrollCallback(window, [](GLFWwindow* w, double, double y) { of(w).scrolled(static_cast<float>(y)); });
        glfwSetDropCallback(window, [](GLFWwindow* w, int count, char const** files) {
            of(w).input.dropped.assign(files, files + count);
        });
        glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { of(w).read_size(); });
        glfwSetWindowContentScaleCallback(window, [](GLFWwindow* w, float, float) { of(w).input.redraw = true; });
        glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { of(w).input.redraw = true; });
        glfwSetWindowCloseCallback(window, [](GLFWwindow* w) { of(w).input.commands.push_back(Command::quit); });
    }
};

Window::Window(std::string const& title, Viewport size) : impl_(std::make_unique<Impl>()) {
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    impl_->window = glfwCreateWindow(size.width, size.height, title.c_str(), nullptr, nullptr);
    if (impl_->window == nullptr) {
        throw InputError("cannot open a window with OpenGL 3.3 (" + last_glfw_error() +
                         "): update the graphics driver, or use framelet-client");
    }
    glfwMakeContextCurrent(impl_->window);
    glfwSwapInterval(1);
    impl_->texture.emplace();
    impl_->size = size;
    impl_->listen();
    impl_->read_size();
}

Window::~Window() = default;

Viewport Window::framebuffer_size() const {
    return impl_->size;
}

float Window::content_scale() const {
    float x = 1;
    float y = 1;
    glfwGetWindowContentScale(impl_->window, &x, &y);
    return std::clamp(y, 0.5f, 8.0f);
}

double Window::refresh_rate() const {
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor(); // asked each frame: where the window is takes longer
    GLFWvidmode const* const mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
    return mode == nullptr || mode->refreshRate <= 0 ? 60 : mode->refreshRate;
}

bool Window::is_hidden() const {
    return glfwGetWindowAttrib(impl_->window, GLFW_ICONIFIED) != 0 ||
           glfwGetWindowAttrib(impl_->window, GLFW_VISIBLE) == 0;
}

void Window::set_title(std::string const& title) {
    glfwSetWindowTitle(impl_->window, title.c_str());
}

void Window::show() {
    glfwShowWindow(impl_->window);
}

void Window::toggle_fullscreen() {
    GLFWwindow* const window = impl_->window;
    auto& windowed = impl_->windowed;
    if (glfwGetWindowMonitor(window) != nullptr) {
        glfwSetWindowMonitor(window, nullptr, windowed.x, windowed.y, windowed.width, windowed.height, 0);
        return;
    }
    GLFWmonitor* const monitor = impl_->monitor();
    GLFWvidmode const* const mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
    if (mode != nullptr) {
        glfwGetWindowPos(window, &windowed.x, &windowed.y);
        glfwGetWindowSize(window, &windowed.width, &windowed.height);
        glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
    }
}

WindowInput Window::wait(double at_most_seconds) {
    if (at_most_seconds > 0) {
        glfwWaitEventsTimeout(impl_->has_gamepad ? std::min(at_most_seconds, gamepad_seconds) : at_most_seconds);
    } else {
        glfwPollEvents();
    }
    impl_->read_held_keys();
    impl_->add_gamepad();
    return std::exchange(impl_->input, WindowInput{});
}

void Window::wake() {
    std::lock_guard const lock(wake_mutex);
    if (can_wake) {
        glfwPostEmptyEvent();
    }
}

void Window::upload(Picture const& picture, std::span<PixelRect const> changed) {
    impl_->texture->upload(picture, changed);
}

void Window::show_texture(std::uint32_t texture, Viewport size) {
    impl_->texture->show(texture, size.width, size.height);
}

void Window::draw_picture() {
    impl_->texture->draw(impl_->size.width, impl_->size.height);
}

void Window::present() {
    glfwSwapBuffers(impl_->window);
}

void Window::set_overlay_areas(std::span<PixelRect const> areas) {
    impl_->overlay.assign(areas.begin(), areas.end());
}

void Window::set_typing(bool is_typing) {
    impl_->is_typing = is_typing;
}

void Window::set_mouse_look(bool looks) {
    impl_->looks = looks;
    impl_->begins_to_look = looks;
    glfwSetInputMode(impl_->window, GLFW_CURSOR, looks ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    impl_->cursor = impl_->pointer(); // it may have been put somewhere else
}

bool Window::has_mouse_look() const {
    return impl_->looks;
}

void Window::set_clipboard(std::string const& text) {
    glfwSetClipboardString(impl_->window, text.c_str());
}

std::string Window::clipboard() const {
    char const* const text = glfwGetClipboardString(impl_->window);
    return text == nullptr ? "" : text;
}

bool Window::is_fullscreen() const {
    return glfwGetWindowMonitor(impl_->window) != nullptr;
}

Viewport Window::windowed_size() const {
    if (is_fullscreen()) {
        return {impl_->windowed.width, impl_->windowed.height};
    }
    Viewport out;
    glfwGetWindowSize(impl_->window, &out.width, &out.height);
    return out;
}

GLFWwindow* Window::handle() const {
    return impl_->window;
}

} // namespace framelet
