#include "client/viewer/legend.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(Legend, EachOverlayHasATooltipAndALegend) {
    for (std::size_t i = 0; i < drawn_over_names.size(); ++i) {
        auto const kind = static_cast<DrawnOver>(i);
        EXPECT_NE(overlay_tip(kind), "") << drawn_over_names[i];
        std::optional<Legend> const legend = legend_of(kind);
        ASSERT_EQ(legend.has_value(), kind != DrawnOver::nothing) << drawn_over_names[i];
        if (legend) {
            EXPECT_NE(legend->title, "");
            EXPECT_NE(legend->tip.find(overlay_tip(kind)), std::string::npos);
            EXPECT_EQ(legend->newest.empty(), legend->oldest.empty());
        }
    }
}

} // namespace
} // namespace framelet
