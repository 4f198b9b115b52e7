// What is drawn over pictures again and again takes no more memory each time.
#include <gtest/gtest.h>

#include "client/core/picture/picture_maker.h"
#include "tests/faults/failing_allocations.h"
#include "tests/picture/synthetic_framelets.h"

namespace framelet::test {
namespace {

TEST(DrawnOverAllocation, IsNoneForRefreshRatesAndArrivals) {
    ImagePlane const plane({200, 120});
    Batch const batch =
        make_batch(plane, 1, shade_tiles(plane, visible_tiles(plane, plane.pixel_depth()), [](float, float) {
                       return std::array<std::uint8_t, 3>{90, 90, 90};
                   }));
    for (DrawnOver const kind : {DrawnOver::refresh_rate, DrawnOver::arrivals}) {
        PictureMaker maker(plane.viewport(), {});
        PictureRequest request;
        request.drawn_over = kind;
        Picture picture;
        std::vector<PixelRect> changed;
        maker.show(request, picture, changed);
        maker.insert(batch);
        maker.show(request, picture, changed);
        Picture const before = picture;
        FailingAllocation const counts(UINT64_MAX);
        for (int i = 0; i < 3; ++i) {
            maker.draw_over(picture);
        }
        EXPECT_EQ(counts.count(), 0u) << name_of(kind);
        EXPECT_NE(picture, before);
    }
}

} // namespace
} // namespace framelet::test
