// Decides what Esc does: it leaves one thing at a time, and the program where it is pressed twice. In: what is open,
// and when the key was pressed. Out: what is left. A value.
#pragma once

#include <cstdint>
#include <optional>

namespace framelet {

enum class EscapeLeaves : std::uint8_t { mouse_look, menu, help, full_screen, nothing_yet, program };

struct OpenThings {
    bool mouse_look = false, menu = false, help = false, full_screen = false;
};

class EscapeKey {
public:
    /// Most time between two that leave the program, seconds.
    static constexpr double most_pause = 1;

    EscapeLeaves press(OpenThings const& open, double now_seconds) {
        std::optional<double> const before = pressed_;
        pressed_.reset();
        if (open.mouse_look) {
            return EscapeLeaves::mouse_look;
        }
        if (open.menu) {
            return EscapeLeaves::menu;
        }
        if (open.help) {
            return EscapeLeaves::help;
        }
        if (open.full_screen) {
            return EscapeLeaves::full_screen;
        }
        if (before && now_seconds - *before <= most_pause) {
            return EscapeLeaves::program;
        }
        pressed_ = now_seconds;
        return EscapeLeaves::nothing_yet;
    }

private:
    std::optional<double> pressed_; ///< when it was, with nothing left to leave but the program
};

} // namespace framelet
