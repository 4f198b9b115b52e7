// The samples of everything that is held, on the graphics card: the grids of a plan's squares as pages of an array of
// textures. In: grids, and which of their samples have been written. Out: where they are.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "client/gpu/gl/gl_objects.h"
#include "common/warp/merging/merged_square.h"

namespace framelet {

class SampleAtlas {
public:
    static constexpr int layer_side = 1024; ///< side of each layer of the texture, samples; every card can have that
    static constexpr int most_layers = 256; ///< every card can have so many: 1 GB

    /// The position of a grid's first sample in the texture.
    struct Position {
        std::uint32_t x = 0, y = 0, layer = 0;
    };

    explicit SampleAtlas(GlCount& count) : count_(count) {}

    /// Empties the atlas; its memory stays.
    void clear();
    /// The grid of a square of a slot's plan.
    struct Grid {
        std::size_t slot = 0;
        std::uint32_t square = 0;
        MergedSquare* samples = nullptr;
    };
    /// Samples that are in no square's grid, 16 along a side at most, `side` from one row to the next.
    struct SmallGrid {
        PackedSample const* samples = nullptr;
        int side = 0;
    };
    /// Uploads what has been written of grids since they were uploaded last, and all small ones, which are for one
    /// picture. Other grids may be evicted: nobody has asked for them for this picture. Throws CanvasError where
    /// there is no room.
    void update(std::span<Grid const> grids, std::span<SmallGrid const> small_ones);
    /// The position of one of the last update's grids.
    Position position(std::size_t slot, std::uint32_t square) const;
    /// The position of one of the last update's small grids, by number.
    Position small_position(std::size_t number) const { return position_of(small_pages_[number], 0); }

    std::uint32_t texture() const { return texture_.get(); }

private:
    struct Page {
        std::int32_t number = -1; ///< -1: none
        std::uint8_t size = 0; ///< an index of `free_`
        bool is_uploaded = false;
        std::uint64_t picture = 0; ///< number of the one in which it was used last
    };

    Page& prepare(Grid const& grid);
    void upload(Grid const& grid, Page& page);
    std::int32_t take(std::size_t size);
    void evict();
    void grow();
    static int side_of(std::size_t size) { return least_side << size; }
    static Position position_of(std::int32_t number, std::size_t size);

    static constexpr int least_side = 16;
    static constexpr std::size_t sizes = 4; ///< 16, 32, 64, 128 samples along a side

    GlCount& count_;
    GlName texture_;
    int layers_ = 0, used_layers_ = 0;
    std::uint64_t picture_ = 0;
    std::array<std::vector<std::int32_t>, sizes> free_; ///< numbers of pages: layer * pages of a layer + page
    std::vector<std::vector<Page>> pages_; ///< by slot and square
    std::vector<std::int32_t> small_pages_; ///< numbers of pages of the smallest size
};

} // namespace framelet
