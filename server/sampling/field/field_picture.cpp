#include "server/sampling/field/field_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/error.h"

namespace framelet {
namespace {

using Color = std::array<std::uint8_t, 3>;

constexpr Color outline{64, 120, 200}; // not grey, so that it differs from every value

Color grey(float value, float least, float most) {
    float const share = value > least ? std::log(value / least) / std::log(most / least) : 0;
    auto const level = static_cast<std::uint8_t>(std::lround(255 * std::clamp(share, 0.0f, 1.0f)));
    return {level, level, level};
}

void fill(Picture& picture, PixelRect const& rect, Color const& color) {
    for (int y = rect.top; y < std::min(rect.bottom, picture.height); ++y) {
        std::uint8_t* pixel = picture.row(y) + 4 * static_cast<std::ptrdiff_t>(rect.left);
        for (int x = rect.left; x < std::min(rect.right, picture.width); ++x, pixel += 4) {
            std::copy(color.begin(), color.end(), pixel);
            pixel[3] = 255;
        }
    }
}

/// Draws the left and the upper edge of a rectangle; the other two are edges of its neighbours.
void draw_edges(Picture& picture, PixelRect const& rect) {
    fill(picture, {rect.left, rect.top, rect.right, rect.top + 1}, outline);
    fill(picture, {rect.left, rect.top, rect.left + 1, rect.bottom}, outline);
}

/// Refreshes a second; 0 for what stands still, which is never due again.
float refresh_rate(Region const& region, SamplingChoice const& choice) {
    return region.model.motion > 0 && choice.period > 0 ? 1 / choice.period : 0;
}

Color color_of(Region const& region, SamplingChoice const& choice, FieldView view) {
    switch (view) {
    case FieldView::tiles:
        return grey(refresh_rate(region, choice), 0.1f, 60);
    case FieldView::density:
        return grey(samples_per_pixel(choice.level), samples_per_pixel(0) / 2, samples_per_pixel(sampling_levels - 1));
    case FieldView::error:
        return grey(shown_error(region, 0), 1e-6f, bare_error);
    case FieldView::motion:
        return grey(region.model.motion, 0.01f, 64);
    }
    return {};
}

} // namespace

Picture draw_field(RegionField const& field, std::span<SamplingChoice const> choices, std::span<Patch const> cut,
                   FieldView view) {
    FRAMELET_CHECK(choices.size() == field.size());
    Viewport const viewport = field.plane().viewport();
    Picture picture(viewport.width, viewport.height);
    for (std::uint32_t const index : field.visible()) {
        fill(picture, field.rect_of(index), color_of(field[index], choices[index], view));
    }
    if (view == FieldView::tiles) {
        std::vector<Tile> tiles;
        for (Patch const& patch : cut) {
            append_tiles(field.plane(), patch, tiles);
        }
        for (Tile const tile : tiles) {
            draw_edges(picture, field.plane().tile_rect(tile));
        }
    }
    return picture;
}

} // namespace framelet
