#include "server/sampling/held/held_tiles.h"

#include <algorithm>
#include <cstring>

#include "common/mix_bits.h"
#include "common/morton.h"

namespace framelet {
namespace {

constexpr int place_side = framelet_side >> finest_levels; ///< pixels

int places_along(int pixels) {
    return (pixels + place_side - 1) / place_side;
}

} // namespace

std::uint64_t content_of(DisplayFramelet const& framelet) {
    std::uint64_t content = 0;
    for (auto const* plane : {&framelet.red, &framelet.green, &framelet.blue}) {
        for (std::size_t i = 0; i < framelet_samples; i += sizeof(std::uint64_t)) {
            std::uint64_t word = 0;
            std::memcpy(&word, plane->data() + i, sizeof(word));
            content = mix_in(content, word);
        }
    }
    return content != 0 ? content : 1;
}

HeldTiles::HeldTiles(ImagePlane const& plane)
    : plane_(plane), columns_(places_along(plane.viewport().width)), rows_(places_along(plane.viewport().height)),
      places_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {}

std::size_t HeldTiles::bytes(Viewport viewport) {
    return static_cast<std::size_t>(places_along(viewport.width)) *
           static_cast<std::size_t>(places_along(viewport.height)) * sizeof(Place);
}

template <class Is>
bool HeldTiles::all_of(Tile tile, Is is) const {
    PixelRect const rect = plane_.tile_rect(tile);
    int const right = std::min(rect.right / place_side, columns_);
    for (int row = rect.top / place_side; row < std::min(rect.bottom / place_side, rows_); ++row) {
        Place const* const places = places_.data() + static_cast<std::ptrdiff_t>(row) * columns_;
        if (!std::all_of(places + rect.left / place_side, places + right, is)) {
            return false;
        }
    }
    return true;
}

template <class Visit>
void HeldTiles::for_each(Tile tile, Visit visit) {
    PixelRect const rect = plane_.tile_rect(tile);
    int const right = std::min(rect.right / place_side, columns_);
    for (int row = rect.top / place_side; row < std::min(rect.bottom / place_side, rows_); ++row) {
        Place* const places = places_.data() + static_cast<std::ptrdiff_t>(row) * columns_;
        std::for_each(places + rect.left / place_side, places + right, visit);
    }
}

void HeldTiles::put(Tile tile, std::uint64_t content, bool means) {
    auto const depth = static_cast<std::int8_t>(tile.depth());
    for_each(tile, [&](Place& place) {
        // Means are shown besides the single rays that were there before: those say whether they are still true.
        bool const same = means && place.depth == depth && place.camera == camera_;
        place.content = means ? (same ? place.content : 0) : content;
        place.means = means ? content : 0;
        place.camera = camera_;
        place.depth = depth;
    });
}

bool HeldTiles::shows(Tile tile, std::uint64_t content, bool means) const {
    return all_of(tile, [&](Place const& place) {
        return place.depth == tile.depth() && place.camera == camera_ &&
               (means ? place.means : place.content) == content;
    });
}

bool HeldTiles::shows_means(Tile tile) const {
    return !all_of(tile, [](Place const& place) { return place.means == 0; });
}

void HeldTiles::set_lossy(Tile tile, bool is_lossy) {
    for_each(tile, [&](Place& place) {
        lossy_ += is_lossy && !place.is_lossy ? 1 : 0;
        lossy_ -= !is_lossy && place.is_lossy ? 1 : 0;
        place.is_lossy = is_lossy;
    });
}

bool HeldTiles::is_lossy(Tile tile) const {
    return lossy_ > 0 &&
           all_of(tile, [&](Place const& place) { return place.is_lossy && place.depth == tile.depth(); });
}

void HeldTiles::list_lossy(std::size_t most, std::vector<Tile>& tiles) const {
    tiles.clear();
    std::uint32_t const first = 1u << (2 * plane_.max_depth());
    for (std::size_t i = 0; i < places_.size() && tiles.size() < std::min(most, lossy_); ++i) {
        if (places_[i].is_lossy) {
            auto const column = static_cast<std::uint32_t>(i) % static_cast<std::uint32_t>(columns_);
            auto const row = static_cast<std::uint32_t>(i) / static_cast<std::uint32_t>(columns_);
            tiles.push_back({first + morton_index(column, row)});
        }
    }
}

} // namespace framelet
