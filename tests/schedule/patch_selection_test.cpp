#include "server/schedule/patch_selection.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace framelet {
namespace {

TEST(Inspections, LookAtEveryPlaceAndTakeNoTileTwice) {
    PlaceField const field{ImagePlane({128, 128})};
    int const fine = field.plane().pixel_depth();
    std::vector<Patch> patches{{make_tile(field.depth(), 3, 5), fine}, {Tile{1}.child(1), fine - 1}};
    std::vector<std::uint32_t> scratch;
    select_inspections(field, 100, {.samples_per_second = 1e9, .cycle_seconds = 1}, scratch, patches);

    std::vector<Tile> tiles;
    for (Patch const& patch : patches) {
        append_tiles(field.plane(), patch, tiles);
    }
    std::ranges::sort(tiles);
    EXPECT_EQ(std::ranges::adjacent_find(tiles), tiles.end()) << "a tile twice";
    EXPECT_EQ(std::ranges::count(tiles, fine, &Tile::depth), 64) << "every place is looked at";
}

} // namespace
} // namespace framelet
