// Plans where everything that is held shows in the picture of another camera at another time: a patch for each layer, a
// splat for each outlier, and for each block of the picture the patches that may touch it. In: cache, display camera
// and time, motions. Out: the plan, from which every block is painted on its own.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/framelet/body_motion.h"
#include "common/held/framelet_cache.h"
#include "common/warp/framelet_warp.h"
#include "common/warp/merging/merged_square.h"
#include "common/warp/warp_patch.h"

namespace framelet {

/// The part of a square's grid that has a patch's samples: they begin in this column and row, and have this number
/// instead of a layer's.
struct GridPart {
    int column = 0, row = 0;
    std::uint32_t number = 0;
    LayerSet ends_before{}; ///< numbers, as in `WarpPatch`
};

class WarpPlan {
public:
    /// Largest number of patches that are kept for a block, on the average. Where a camera goes so near that there
    /// would be more, the first ones in the order of painting are kept.
    static constexpr std::size_t most_patches_per_block = 256;
    /// Number of plans for which a square in which nothing is held keeps its memory: the next moment, some tenths of a
    /// second later, mostly needs it again. Squares of framelets finer than pixels keep none: those are held where the
    /// camera rests, and take sixteen times as much.
    static constexpr int most_empty_pictures = 30;

    WarpPlan();
    ~WarpPlan();
    WarpPlan(WarpPlan&&) noexcept;
    WarpPlan& operator=(WarpPlan&&) noexcept;

    /// Replaces the plan; `cache` and `slot` are always the same ones. Squares of which all stays as it was planned
    /// last are kept. Runs in parallel; allocates only where more is held than ever before.
    void make(FrameletCache const& cache, std::size_t slot, SlotRole role, Camera const& display,
              SceneTime display_time, BodyMotions const& motions);

    int columns() const { return columns_; }
    int rows() const { return rows_; }
    /// Sets the flags of those blocks whose plan may not be what it was before `make` was called last.
    void flag_replanned(std::vector<std::uint8_t>& blocks) const;
    /// Adds the patches that may touch a block to `patches`.
    void add_block(std::size_t index, std::vector<PatchView>& patches);
    /// Adds the tiles of those framelets that were noted to show since the plan was made; some come more than once.
    void add_shown(std::vector<Tile>& tiles) const;
    /// Number of the squares of the plan, whether anything is held of them or not.
    std::size_t square_count() const { return squares_.size(); }
    std::size_t patch_count(std::uint32_t square) const { return squares_[square].patches.size(); }
    std::span<WarpPatch const> patches_of(std::uint32_t square) const { return squares_[square].patches; }
    /// Index of a patch in `patches_of` its square.
    std::size_t number_of(WarpPatch const& patch) const {
        return static_cast<std::size_t>(&patch - squares_[patch.square].patches.data());
    }
    /// The samples of a square, among which those of all its patches are.
    MergedSquare& square_grid(std::uint32_t square) { return squares_[square].merged; }
    /// Finds a patch's samples in the grid of its square; the patch must not be of outliers. Returns nothing where they
    /// are in the patch's own grid alone: there they are told from those of another layer, with which they are merged
    /// in the square's.
    std::optional<GridPart> grid_part(WarpPatch const& patch) const;

private:
    /// All framelets of one depth below a tile.
    struct Square {
        Tile tile;
        int depth = 0; ///< of the framelets
        MergedSquare merged;
        std::vector<PixelRect> before; ///< where its patches were before it was planned

        std::vector<WarpPatch> patches;
        std::vector<Splat> splats;
        /// By patch: a bit for each of its framelets, as in `MergedLayer::parts`.
        std::vector<std::uint64_t> framelets;
        std::vector<std::uint8_t> shows; ///< by patch: whether something of it showed when blocks were painted

        void clear();
        /// Frees the memory of a square of which nothing is held.
        void give_back_room();
        /// Notes that the patches that have been added since the last call are of these framelets.
        void note_framelets(std::uint64_t some) { framelets.resize(patches.size(), some); }
        /// Notes the square's number in all its patches, once all are there.
        void note_number(std::uint32_t number);
    };

    /// Facts about a square, kept close together since all are looked at each time.
    struct Known {
        std::size_t index = 0; ///< of the square in the cache's `square_changes`
        std::uint64_t change = 0; ///< its entry there when it was planned
        TimeSpan lasts{0, -1}; ///< display times for which the plan holds
        bool is_empty = true; ///< has no patches
        bool holds = false; ///< something is held in it
        int empty_pictures = most_empty_pictures; ///< plans since something was held in it; at the most it has no room
    };

    /// A set of layers: bit p of word k is layer k of the framelet of index p.
    using LayerBits = std::array<std::uint64_t, max_layers>;

    WarpPatch const& patch_at(std::uint32_t entry) const;
    void set_squares(FrameletCache const& cache);
    void give_back_room();
    static void plan(Square& square, bool outliers, FrameletWarp& warp);
    static bool add_merged(MergedLayer const& merged, FrameletWarp& warp, Square& square);
    static void add_parts(MergedLayer const& merged, FrameletWarp& warp, Square& square, LayerBits& alone);
    bool count_entries(std::size_t most);
    void limit_entries(std::size_t most);
    void make_bins();

    int columns_ = 0, rows_ = 0;
    ImagePlane plane_; ///< of the squares
    std::vector<Square> squares_; ///< all squares in which something can be held
    std::vector<Known> known_; ///< by square
    std::vector<std::uint32_t> replanned_; ///< squares that were planned when the plan was made last
    std::vector<std::uint32_t> occupied_; ///< squares with patches
    struct Mergings;
    std::unique_ptr<Mergings> mergings_; ///< scratch
    Camera display_; ///< the camera that the plan is for
    SlotRole role_;
    TimeSpan valid_; ///< when what was rendered is not out of date
    bool is_limited_ = false; ///< there is no room for all patches
    std::vector<std::uint32_t> first_entry_; ///< index of each block's first entry; one more at the end
    std::vector<std::uint32_t> next_entry_;
    std::vector<std::uint32_t> entries_; ///< square * patches_per_square + patch
};

/// Puts the patches of a block into the order in which they are painted: the best samples first, the newest of those,
/// then by tiles and layers.
void order(std::vector<PatchView>& patches);

} // namespace framelet
