// Lets the user choose files by the desktop's own dialog, which is a program beside the window. Out: their names, once
// the user has chosen.
#pragma once

#include <functional>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "client/processes/child.h"

namespace framelet {

class FileDialog {
public:
    /// `on_answer` is called from another thread once `poll` has something to say.
    explicit FileDialog(std::function<void()> on_answer) : on_answer_(std::move(on_answer)) {}

    /// Shows the dialog, unless it is there already. Throws InputError where there is no program for it,
    /// std::system_error.
    void open();
    /// The files that were chosen, once; empty while none are.
    std::vector<std::string> poll();

private:
    std::function<void()> const on_answer_;
    std::future<std::string> answer_; ///< ends with the program
    std::optional<Child> program_;
};

} // namespace framelet
