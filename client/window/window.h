// The window: GLFW and OpenGL 3.3. In: a picture and what changed of it. Out: what the user's hands did since the last
// look, as plain values. All but `wake` is called from the main thread.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "client/core/camera/camera_controller.h"
#include "client/viewer/commands.h"
#include "common/framelet/tile.h"
#include "common/image.h"

struct GLFWwindow;

namespace framelet {

/// The input since the last look.
struct WindowInput {
    std::vector<Command> commands; ///< in order
    Vec2 orbit{0, 0}; ///< dragged, pixels of the framebuffer, x right, y down
    Vec2 pan{0, 0}; ///< likewise
    float dolly = 0; ///< steps, positive: nearer
    Vec2 look{0, 0}; ///< way of the mouse while it turns the head, likewise
    float speed = 0; ///< steps of the wheel while the mouse turns the head
    std::optional<Vec2> grabbed; ///< where a drag has begun, or the wheel has turned first; pixels of the framebuffer
    std::optional<Vec2> focused; ///< where a double click was; pixels of the framebuffer
    FlyInput fly; ///< by what is held now
    std::vector<std::string> dropped; ///< names of files
    bool redraw = false; ///< exposed or resized
    bool touched_overlay = false; ///< the pointer did something in its area, or has left it, or a key was typed into it

    bool moved_camera() const {
        return orbit != Vec2(0, 0) || pan != Vec2(0, 0) || dolly != 0 || look != Vec2(0, 0) || fly.moving();
    }
};

class Window {
public:
    /// Makes a window of this size, hidden until `show`. Throws InputError where there is no display or no OpenGL 3.3.
    Window(std::string const& title, Viewport size);
    ~Window();
    Window(Window const&) = delete;
    Window& operator=(Window const&) = delete;

    /// Size of the framebuffer, pixels; each side at least 1. An iconified window keeps its size.
    Viewport framebuffer_size() const;
    /// Pixels of the framebuffer for one unit of text size; another one on another screen, which is a `redraw`.
    float content_scale() const;
    /// Frames a second of the main screen; 60 where that is not known.
    double refresh_rate() const;
    /// True where the window is iconified, or on no screen at all: nobody sees what is drawn. A window that others
    /// cover is not told of it.
    bool is_hidden() const;
    bool is_fullscreen() const;
    /// The window's size, or the one that it would go back to from the full screen; in the units of the constructor.
    Viewport windowed_size() const;
    void set_title(std::string const& title);
    void show();
    /// Fills the screen that the window is on, or goes back.
    void toggle_fullscreen();

    /// Sleeps until something happens, somebody calls `wake` or the time is over; then returns what happened.
    WindowInput wait(double at_most_seconds);
    /// Ends `wait`; does nothing while there is no window. May be called from any thread.
    static void wake();

    /// Uploads the changed rectangles of the picture (as `FrameletCache::take_changed` orders them: by rows).
    void upload(Picture const& picture, std::span<PixelRect const> changed);
    /// Shows a texture of this context instead, rows from the top, until something is uploaded.
    void show_texture(std::uint32_t texture, Viewport size);
    /// Fills the framebuffer with the picture, stretched.
    void draw_picture();
    /// Shows what was drawn.
    void present();

    /// Sets the areas, pixels of the framebuffer, in which the mouse is the overlay's and not the camera's; a drag
    /// belongs to where it began.
    void set_overlay_areas(std::span<PixelRect const> areas);
    /// Gives the keys to the overlay: they are neither commands nor ways to fly.
    void set_typing(bool is_typing);
    /// Takes the pointer away: the mouse turns the head, the wheel is the speed, and a click is `Command::mouse_look`.
    void set_mouse_look(bool looks);
    bool has_mouse_look() const;
    void set_clipboard(std::string const& text);
    /// The text of the clipboard; empty where it has none.
    std::string clipboard() const;
    /// GLFW's window, for the overlay's backend.
    GLFWwindow* handle() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace framelet
