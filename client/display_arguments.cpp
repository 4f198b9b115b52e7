#include "client/display_arguments.h"

#include <string>

#include "client/core/client_core.h"
#include "common/command_line/number_range.h"

namespace framelet {

void add_display_options(CLI::App& app, DisplayArguments& arguments) {
    app.option_defaults()->group("Display");
    app.add_option("--exposure", arguments.exposure_ev,
                   "Stops brighter (or darker: negative) than the server's exposure")
        ->type_name("STOPS")
        ->check(number_in(-16.0, 16.0))
        ->capture_default_str();
    CLI::Option* const unwarped =
        app.add_flag("--no-reprojection", arguments.unwarped,
                     "Show pixels where they were rendered: nothing is moved to where it is by now");
    std::string const usual = std::to_string(static_cast<int>(1e3 * usual_lag_seconds));
    app.add_flag("--smooth{" + usual + "}", arguments.smooth_ms,
                 "Show the scene, not the camera, " + usual +
                     " or MS milliseconds late: between what was rendered before that moment and after it, instead of "
                     "going on from what is newest")
        ->option_text("MS")
        ->check(number_in(0.0, 1e3 * max_lag_seconds))
        ->excludes(unwarped);
}

} // namespace framelet
