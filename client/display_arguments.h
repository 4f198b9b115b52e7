// The part of the command line that both programs share: how the scene is to look.
#pragma once

#include "common/command_line/command_line.h"
#include "protocol/messages/message.h"

namespace framelet {

/// The display options as they were written on the command line.
struct DisplayArguments {
    float exposure_ev = 0;
    bool unwarped = false;
    double smooth_ms = 0;

    ViewerSettings settings() const { return {exposure_ev, 0, !unwarped}; }
    /// The lag for `ClientCore::set_smoothing`, seconds.
    double lag_seconds() const { return 1e-3 * smooth_ms; }
};

/// Adds --exposure, --no-reprojection and --smooth. The arguments must outlive the parsing.
void add_display_options(CLI::App& app, DisplayArguments& arguments);

} // namespace framelet
