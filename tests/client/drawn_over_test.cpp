#include "client/core/drawn_over/drawn_over.h"

#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "client/core/picture/session_pictures.h"
#include "client/display_arguments.h"
#include "tests/picture/synthetic_framelets.h"

namespace framelet {
namespace {

std::size_t const kinds = drawn_over_names.size();

TEST(DrawnOver, EachKindHasANameAndATurn) {
    DrawnOver kind = DrawnOver::nothing;
    std::set<std::string> names;
    for (std::size_t i = 0; i < kinds; ++i) {
        EXPECT_TRUE(names.insert(name_of(kind)).second);
        EXPECT_EQ(drawn_over_of(name_of(kind)), kind);
        kind = next_of(kind);
    }
    EXPECT_EQ(kind, DrawnOver::nothing);
    EXPECT_EQ(drawn_over_of("foo"), std::nullopt);
    EXPECT_EQ(drawn_over_of(""), std::nullopt);
    EXPECT_EQ(list_of_drawn_over(), "none, ages, confidence, refresh-rate, arrivals or holes");
}

DisplayChoice choice_of(std::vector<char const*> words) {
    CLI::App app("Shows something.", "program");
    prepare_command_line(app);
    DisplayChoice choice;
    add_display_options(app, choice);
    words.insert(words.begin(), "program");
    parse_command_line(app, static_cast<int>(words.size()), words.data());
    return choice;
}

TEST(DisplayArguments, TakeEachOverlayByItsName) {
    EXPECT_EQ(choice_of({}).drawn_over, DrawnOver::nothing);
    EXPECT_EQ(choice_of({"--overlay"}).drawn_over, DrawnOver::ages);
    for (std::size_t i = 0; i < kinds; ++i) {
        EXPECT_EQ(choice_of({"--overlay", drawn_over_names[i]}).drawn_over, static_cast<DrawnOver>(i));
    }
    try {
        choice_of({"--overlay", "foo"});
        ADD_FAILURE();
    } catch (CLI::ParseError const& error) {
        EXPECT_NE(std::string(error.what()).find(list_of_drawn_over()), std::string::npos) << error.what();
    }
}

TEST(DisplayArguments, TellWhatIsSaidFromWhatIsNot) {
    DisplayChoice const none = choice_of({});
    EXPECT_EQ(none.exposure_ev, std::nullopt);
    EXPECT_EQ(none.lag_seconds, std::nullopt);
    EXPECT_EQ(none.settings(), ViewerSettings());
    EXPECT_EQ(choice_of({"--smooth"}).lag_seconds, 0.1);
    EXPECT_EQ(choice_of({"--smooth", "50"}).lag_seconds, 0.05);
    EXPECT_EQ(choice_of({"--smooth=0"}).lag_seconds, 0);
    EXPECT_EQ(choice_of({"--exposure", "-1.5"}).exposure_ev, -1.5f);
    EXPECT_FALSE(choice_of({"--no-reprojection"}).settings().reproject);
    EXPECT_THROW(choice_of({"--no-reprojection", "--smooth"}), CLI::ParseError);
}

/// A viewer that holds the left 32 columns of its picture.
struct LeftThird {
    ImagePlane plane{Viewport{100, 60}};
    SessionPictures pictures;
    NumberedView view{1, {}, plane.viewport(), 1};
    PictureSettings settings;
    PictureRequest request;
    Picture picture;
    std::vector<PixelRect> changed;
    std::uint64_t batches = 0;

    explicit LeftThird(bool moves_samples) { settings.reproject = moves_samples; }

    void insert() {
        std::vector<Tile> tiles = visible_tiles(plane, plane.pixel_depth());
        std::erase_if(tiles, [&](Tile tile) { return plane.tile_rect(tile).left >= 32; });
        auto const shade = [](float, float) { return std::array<std::uint8_t, 3>{90, 90, 90}; };
        pictures.prepare(view, settings).insert(make_batch(plane, ++batches, shade_tiles(plane, tiles, shade)));
    }
    void show(double now) {
        request.now = now;
        pictures.prepare(view, settings);
        pictures.show(request, picture, changed);
    }
    Picture drawn(DrawnOver what) {
        request.drawn_over = what;
        show(request.now);
        Picture out = picture;
        pictures.shown()->draw_over(out);
        return out;
    }
};

std::size_t different_pixels(Picture const& a, Picture const& b, int from, int to) {
    std::size_t count = 0;
    for (int y = 0; y < a.height; ++y) {
        for (int x = from; x < to; ++x) {
            count += std::equal(a.row(y) + 4 * x, a.row(y) + 4 * x + 4, b.row(y) + 4 * x) ? 0 : 1;
        }
    }
    return count;
}

TEST(DrawnOver, ShowsItsOwnWhereItIs) {
    for (bool const moves_samples : {true, false}) {
        LeftThird viewer(moves_samples);
        viewer.insert();
        viewer.show(0);
        EXPECT_EQ(viewer.drawn(DrawnOver::nothing), viewer.picture);
        for (DrawnOver const kind : {DrawnOver::ages, DrawnOver::arrivals}) {
            EXPECT_GT(different_pixels(viewer.drawn(kind), viewer.picture, 0, 32), 100u) << name_of(kind);
            EXPECT_EQ(different_pixels(viewer.drawn(kind), viewer.picture, 32, 100), 0u) << name_of(kind);
        }
        Picture const holes = viewer.drawn(DrawnOver::holes);
        EXPECT_EQ(different_pixels(holes, viewer.picture, 0, 32), 0u);
        EXPECT_EQ(different_pixels(holes, viewer.picture, 32, 100), 68u * 60u);
        EXPECT_EQ(different_pixels(viewer.drawn(DrawnOver::confidence), viewer.picture, 32, 100) > 0, moves_samples)
            << "outlines are of what is held";
    }
}

TEST(DrawnOver, RefreshesAreCountedWhileTheyAreDrawn) {
    LeftThird viewer(true);
    viewer.insert();
    viewer.show(0);
    Picture const grey = viewer.drawn(DrawnOver::refresh_rate);
    EXPECT_EQ(different_pixels(grey, viewer.picture, 0, 32), 0u) << "what came before is not counted";
    EXPECT_FALSE(viewer.pictures.shown()->drawn_over_fades());
    viewer.insert();
    viewer.show(0.1);
    EXPECT_TRUE(viewer.pictures.shown()->drawn_over_fades());
    Picture const washed = viewer.drawn(DrawnOver::refresh_rate);
    EXPECT_EQ(different_pixels(washed, grey, 0, 32), 32u * 60u);
    EXPECT_EQ(different_pixels(washed, grey, 32, 100), 0u);
    viewer.show(20);
    EXPECT_FALSE(viewer.pictures.shown()->drawn_over_fades());
    EXPECT_EQ(viewer.drawn(DrawnOver::refresh_rate), grey);
    viewer.insert();
    viewer.drawn(DrawnOver::nothing);
    EXPECT_FALSE(viewer.pictures.shown()->drawn_over_fades());
    EXPECT_EQ(viewer.drawn(DrawnOver::refresh_rate), grey) << "it begins anew";
}

} // namespace
} // namespace framelet
