// The help that F1 shows. In: why some commands have no effect now. Out: groups of keys and what they do.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "client/window/overlay/command.h"

namespace framelet {

using TextRows = std::vector<std::pair<std::string, std::string>>; ///< name and value

struct HelpGroup {
    std::string title;
    TextRows rows;
    bool operator==(HelpGroup const&) const = default;
};

/// Text that is shown where another viewer has the scene's clock at its disposal.
inline constexpr char const* watching_text = "another viewer controls the scene's clock";

/// Text that is shown where no scene's clock moves anything.
inline constexpr char const* nothing_moves_text = "nothing moves in this scene";

/// Text that is shown while the mouse turns the head.
inline constexpr char const* mouse_look_text = "the mouse looks around, W A S D Q E fly; a click or Esc ends it";

/// Text that is shown after an Esc that leaves nothing yet.
std::string escape_note();

/// The help: what one needs first comes first. `clock_lacks`: why the keys that set the scene's clock have no effect;
/// empty: they have one.
std::vector<HelpGroup> help_groups(std::string const& clock_lacks);

/// The number of groups that stand on the left where the help has two columns, of which the higher one is as low as can
/// be.
std::size_t left_groups(std::span<HelpGroup const> shown);

/// The help's words for one command, for the tooltip of what does the same by mouse. All numbered cameras of a kind
/// have the same.
std::string help_text(Command command);

} // namespace framelet
