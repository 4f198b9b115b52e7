// The help that F1 shows. In: why some commands have no effect now. Out: rows of keys and what they do, in two columns.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "client/window/overlay/command.h"

namespace framelet {

using TextRows = std::vector<std::pair<std::string, std::string>>; ///< name and value

/// Text that is shown where another viewer has the scene's clock at its disposal.
inline constexpr char const* watching_text = "another viewer controls the scene's clock";

/// Text that is shown while the mouse turns the head.
inline constexpr char const* mouse_look_text = "the mouse looks around, W A S D Q E fly; a click or Esc ends it";

/// Text that is shown after an Esc that leaves nothing yet.
std::string escape_note();

/// The rows of the help. `clock_lacks`: why the keys that set the scene's clock have no effect; empty: they have one.
TextRows help_rows(std::string const& clock_lacks);

/// The help's words for one command, for the tooltip of what does the same by mouse. All numbered cameras of a kind
/// have the same.
std::string help_text(Command command);

} // namespace framelet
