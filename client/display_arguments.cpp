#include "client/display_arguments.h"

#include <string>

#include "client/core/client_core.h"
#include "common/command_line/number_range.h"

namespace framelet {

namespace {

/// Puts the number of the kind of overlay in place of its name, which is what CLI11 reads an enumeration from.
CLI::Validator overlay_kind() {
    return {[](std::string& input) {
                std::optional<DrawnOver> const kind = drawn_over_of(input);
                if (!kind) {
                    return "'" + input + "' is no overlay: write " + list_of_drawn_over();
                }
                input = std::to_string(static_cast<int>(*kind));
                return std::string();
            },
            ""};
}

} // namespace

void add_display_options(CLI::App& app, DisplayChoice& choice) {
    app.option_defaults()->group("Display");
    app.add_option("--exposure", choice.exposure_ev,
                   "Stops brighter (or darker: negative) than the server's exposure; in the window it is otherwise as "
                   "it was last in this scene")
        ->type_name("STOPS")
        ->check(number_in(-16.0, 16.0))
        ->default_str("0");
    CLI::Option* const unwarped =
        app.add_flag("--no-reprojection", choice.unwarped,
                     "Show pixels where they were rendered: nothing is moved to where it is by now");
    std::string const usual = std::to_string(static_cast<int>(1e3 * usual_lag_seconds));
    std::string const smooth = "Show the scene, not the camera, " + usual +
                               " or MS milliseconds late: between what was rendered before that moment and after it, "
                               "instead of going on from what is newest";
    app.add_flag("--smooth{" + usual + "}", smooth)
        ->option_text("MS")
        ->check(number_in(0.0, 1e3 * max_lag_seconds))
        ->each([&choice](std::string const& milliseconds) { choice.lag_seconds = 1e-3 * std::stod(milliseconds); })
        ->excludes(unwarped);
    app.add_flag("--overlay{ages}", choice.drawn_over,
                 "Draw over pictures: outlines of the framelets that are held, fresh ones bright (ages); how old and "
                 "how coarse each pixel is (confidence); how often a second 16x16 pixels are replaced (refresh-rate); "
                 "outlines of what the newest batch has brought (arrivals); what nothing is held of (holes)")
        ->option_text("KIND")
        ->transform(overlay_kind());
}

} // namespace framelet
