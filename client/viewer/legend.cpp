#include "client/viewer/legend.h"

#include "client/viewer/commands.h"

namespace framelet {

std::string overlay_tip(DrawnOver drawn) {
    switch (drawn) {
    case DrawnOver::nothing:
        return "nothing is drawn over the picture";
    case DrawnOver::ages:
        return "outlines of the framelets that are held, where they were rendered, by when they came";
    case DrawnOver::confidence:
        return "how far each pixel is to be trusted: when it was rendered, and how coarsely";
    case DrawnOver::refresh_rate:
        return "how often each 16x16 pixels have been replaced, of about the last second";
    case DrawnOver::arrivals:
        return "outlines of what the newest batch has brought, where it was rendered";
    case DrawnOver::holes:
        return "pixels that nothing is held of: what shows there is made up from what is around";
    }
    return "";
}

std::optional<Legend> legend_of(DrawnOver drawn) {
    std::string const tip = with_keys(overlay_tip(drawn), Command::next_overlay);
    switch (drawn) {
    case DrawnOver::nothing:
        break;
    case DrawnOver::ages:
        return Legend{"framelets that are held (F3)", "came last", "1000 batches ago", "", tip};
    case DrawnOver::confidence:
        return Legend{"when each pixel was rendered (F3)", "now", "10 s ago",
                      "the darker the coarser; magenta: made up", tip};
    case DrawnOver::refresh_rate:
        return Legend{"how often 16x16 pixels are replaced (F3)", "60 a second", "0.1 a second", "grey: more rarely",
                      tip};
    case DrawnOver::arrivals:
        return Legend{"yellow: what came last (F3)", "", "", "", tip};
    case DrawnOver::holes:
        return Legend{"magenta: nothing is held (F3)", "", "", "", tip};
    }
    return std::nullopt;
}

} // namespace framelet
