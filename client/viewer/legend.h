// What is drawn over the picture, in words. In: its kind. Out: a legend of its colours, and a tooltip.
#pragma once

#include <optional>
#include <string>

#include "client/core/drawn_over/drawn_over.h"

namespace framelet {

/// The meaning of the colours of what is drawn over the picture.
struct Legend {
    std::string title;
    std::string newest, oldest; ///< texts at both ends of the colours; empty: it has one colour
    std::string remark;
    std::string tip;
    bool operator==(Legend const&) const = default;
};

/// Says what this kind of overlay shows, for its tooltip.
std::string overlay_tip(DrawnOver drawn);
/// The legend of what is drawn over the picture; nothing where it needs none.
std::optional<Legend> legend_of(DrawnOver drawn);

} // namespace framelet
