#include "server/sampling/field/field_picture.h"

#include <gtest/gtest.h>

namespace framelet {
namespace {

struct Drawn {
    RegionField field{ImagePlane({200, 120})};
    std::vector<SamplingChoice> choices{field.size(), SamplingChoice{pixel_level, 1, 0}};
    std::vector<Patch> cut;

    Drawn() {
        for (std::uint32_t const index : field.visible()) {
            field[index].model.motion = 0;
            field[index].level = sampling_levels - 1;
        }
    }
    Picture draw(FieldView view) const { return draw_field(field, choices, cut, view); }
};

/// The region that this pixel lies in.
std::uint32_t region_at(RegionField const& field, int x, int y) {
    auto const side = static_cast<std::uint32_t>(field.region_side());
    return morton_index(static_cast<std::uint32_t>(x) / side, static_cast<std::uint32_t>(y) / side);
}

int red_at(Picture const& picture, int x, int y) {
    return picture.row(y)[4 * x];
}

TEST(FieldPicture, ShowsEachRegionWhereItIs) {
    for (auto const& [x, y] : {std::pair{0, 0}, {190, 10}, {5, 110}, {199, 119}}) {
        Drawn drawn;
        std::uint32_t const index = region_at(drawn.field, x, y);
        drawn.field[index].model.motion = 8;
        Picture const picture = drawn.draw(FieldView::motion);
        EXPECT_EQ(picture.width, 200);
        EXPECT_EQ(picture.height, 120);
        PixelRect const rect = drawn.field.rect_of(index);
        for (int row = 0; row < picture.height; ++row) {
            for (int column = 0; column < picture.width; ++column) {
                bool const inside = column >= rect.left && column < rect.right && row >= rect.top && row < rect.bottom;
                ASSERT_EQ(red_at(picture, column, row) > 0, inside) << column << ' ' << row;
                ASSERT_EQ(picture.row(row)[4 * column + 3], 255);
            }
        }
    }
}

TEST(FieldPicture, IsBrighterWhereThereIsMore) {
    Drawn drawn;
    std::uint32_t const index = region_at(drawn.field, 100, 50);
    Region& region = drawn.field[index];
    auto const bright = [&](FieldView view) { return red_at(drawn.draw(view), 100, 50); };

    region.level = -1;
    EXPECT_EQ(bright(FieldView::error), 255) << "bare";
    region.level = 0;
    int const coarse = bright(FieldView::error);
    region.level = pixel_level;
    EXPECT_LT(bright(FieldView::error), coarse);

    int last = 0;
    for (int level = 0; level < sampling_levels; ++level) {
        drawn.choices[index].level = level;
        EXPECT_GT(bright(FieldView::density), last);
        last = bright(FieldView::density);
    }
    EXPECT_EQ(last, 255);

    region.model.motion = 1;
    drawn.choices[index].period = 0.02f;
    int const often = bright(FieldView::tiles);
    drawn.choices[index].period = 2;
    EXPECT_LT(bright(FieldView::tiles), often);
    region.model.motion = 0;
    EXPECT_EQ(bright(FieldView::tiles), 0) << "stands still";
}

TEST(FieldPicture, OutlinesTheTilesOfTheCut) {
    Drawn drawn;
    std::vector<float> density(drawn.field.size(), 1);
    TilingScratch scratch;
    make_density_patches(drawn.field.plane(), density, drawn.field.depth(), scratch, drawn.cut);
    Picture const picture = drawn.draw(FieldView::tiles);
    for (Patch const& patch : drawn.cut) {
        std::vector<Tile> tiles;
        append_tiles(drawn.field.plane(), patch, tiles);
        for (Tile const tile : tiles) {
            PixelRect const rect = drawn.field.plane().tile_rect(tile);
            EXPECT_GT(red_at(picture, rect.left, rect.top), 0);
            if (rect.left + 1 < picture.width && rect.top + 1 < picture.height && rect.width() > 1) {
                EXPECT_EQ(red_at(picture, rect.left + 1, rect.top + 1), 0);
            }
        }
    }
}

} // namespace
} // namespace framelet
