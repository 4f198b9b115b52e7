// The commands of all keys and the keys' names: the one table from which the window takes its keys, the help its lines
// and the tooltips theirs. In: a key. Out: a command. It names GLFW's keys and needs no window.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "client/window/overlay/command.h"

namespace framelet {

/// The modifiers that are held with a key.
struct KeyModifiers {
    bool shift = false;
    bool control = false;
    bool alt = false;

    bool operator==(KeyModifiers const&) const = default;
};

struct KeyMeaning {
    int key; ///< its number in GLFW
    KeyModifiers with;
    Command command;
    bool repeats; ///< it does so again and again while it is held
};

/// The meanings of all keys; each numbered camera has its own.
std::span<KeyMeaning const> key_meanings();

/// The command of a key; nothing where it has none. `held_down`: the key repeats itself. Shift counts only where the
/// table has another meaning with it: which keys want it for a + is the keyboard's business.
std::optional<Command> command_of_key(int key, KeyModifiers with, bool held_down);

/// The keys of a command as they are called on a keyboard: "Space", "Shift+B", "F9"; several are "F2 or Tab".
std::string key_names(Command command);

/// A text followed by the command's keys, as a tooltip says it: "play or pause (Space)".
std::string with_keys(std::string const& what, Command command);

} // namespace framelet
