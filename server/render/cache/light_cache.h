// The light of a scene that changes slowly from place to place, kept in records of cells of surfaces: one cache for all
// viewers. In: places that are looked at, light that was gathered there. Out: light at any place, without rays.
//
// Each cell that is looked at has coarser ones around it, which know of all that was
// gathered in them; a record shows these until it knows more itself (`refresh`).
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "common/per_thread.h"
#include "server/render/cache/light_cells.h"

namespace framelet {

class LightCache {
public:
    static constexpr std::size_t usual_bytes = std::size_t{256} << 20;

    /// `scene_size`: its diagonal, metres. Records that were not looked up for longest leave where all would take more
    /// than `most_bytes`.
    explicit LightCache(float scene_size, std::size_t most_bytes = usual_bytes);

    /// The light at a place, of cells of about this size, metres; false where nothing is known at all. Asks for
    /// records where there are none. Any number of threads may look up at the same time.
    bool look_up(LightPlace const& place, float cell_size, IncomingLight& out);

    /// The light at a place that paths meet, of cells of about this size, metres, or up to four times as wide; asks for
    /// nothing. False where little was gathered there, or where it was checked in an earlier pose than `pose`.
    bool find_known(LightPlace const& place, float cell_size, std::uint32_t pose, IncomingLight& out) const;

    enum class Admitted : std::uint8_t { nothing, some, renumbered };
    /// Makes up to `most` of the records that were asked for, and those around them: who looks up again asks for the
    /// others again. Says whether some were asked for, and whether all have other numbers now. Not to be called while
    /// anything looks up, as all below.
    Admitted admit(std::size_t most);
    /// Whose records are worked on: those that were looked up in the last rounds, or all.
    enum class Use : std::uint8_t { recent, any };
    /// Numbers of records that are not good enough, most wanted first, at most `most`. Returns the standard error of
    /// what all records show that are used, relative, in the mean of squares by how much they are used; 0: none is.
    float list_wanted(std::size_t most, Use use, std::vector<std::uint32_t>& out);
    /// To be called when nobody looks any more at what was looked up: it is not recent from now on.
    void note_unwatched();
    /// Adds what paths have brought to a record, and to all around it where they are of its first ones. `first`: the
    /// luminance that the first of them has brought.
    void add(std::uint32_t record, GatheredLight const& gathered, float first);

    /// Luminance from which on a path of a record is bright: what it brings more is shared with all around.
    float bright_path(std::uint32_t record) const;

    /// Brings so many more of the records that are in use up to date with what is known around them.
    void renew(std::size_t count);

    /// To be called when the scene has another pose: from now on all records are to be checked.
    void note_pose() { ++pose_; }
    /// Numbers of records that were not checked in this pose, at most `most`, those first that were checked longest
    /// ago.
    void list_unchecked(std::size_t most, Use use, std::vector<std::uint32_t>& out);
    /// Takes in what the first path of a record brings now. Where some in a cell bring something else, what was
    /// gathered before counts less, there and around it.
    void check(std::uint32_t record, float first);
    /// To be called when all were checked: cells that have few records learn from those around them.
    void end_checks();

    std::span<LightRecord const> records() const { return cells_.records(); }

private:
    struct Asked {
        LightPlace place;
        int level;
        CellKey key;
    };
    /// What a thread has looked up since records were made.
    struct LookedUp {
        std::vector<Asked> asked;
        std::vector<CellKey> recent; ///< by hash: what was asked for lately
        std::array<LightCells::Around, LightCells::finest + 1> around; ///< by level
        bool any = false;
    };

    void use(std::uint32_t record, bool is_nearest);
    bool tells_of_others(LightRecord const& record, std::uint32_t pose) const;
    static void ask(LightPlace const& place, int level, CellKey const& key, LookedUp& own);
    float add_level(LightPlace const& place, int level, float share, bool asks, LookedUp& own, IncomingLight& out);
    std::uint32_t make(LightPlace const& place, int level);
    void forget_oldest();
    bool find_coarse(LightRecord const& record, IncomingLight& out, float& excess) const;
    void refresh(LightRecord& record);
    void judge_checks(std::uint32_t record);
    void outdate(LightRecord& record, float change);
    void list_in_use(Use use);
    bool is_used(LightRecord const& record, Use use) const;
    void take_wanted(std::size_t most, std::vector<std::uint32_t>& out);

    LightCells cells_;
    std::size_t most_records_;
    GatheredLight everywhere_; ///< first paths of all records: what is shown where nothing is known
    std::uint32_t round_ = 1;
    std::uint32_t pose_ = 1;
    PerThread<LookedUp> looked_up_;
    std::vector<std::pair<float, std::uint32_t>> wanted_; ///< scratch
    std::vector<std::uint8_t> is_used_; ///< scratch
    std::vector<std::uint32_t> in_use_; ///< records that are, and those around them: coarse before fine
    std::size_t next_renewed_ = 0; ///< of `in_use_`
};

} // namespace framelet
