#include "server/render/cache/light_cache.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "common/mix_bits.h"
#include "server/render/light/luminance.h"

namespace framelet {
namespace {

constexpr std::uint32_t nothing = LightCells::nothing;
constexpr int finest_cells = LightCells::finest;
/// Levels from a record to the one around it.
constexpr int parent_levels = 2;
/// Records around a place that weigh less together say nothing there.
constexpr float least_weight = 1e-4f;
/// The relative standard error that is good enough, and the paths after which nothing more is tried.
constexpr float enough_error = 0.02f;
constexpr float most_paths = 4096;
/// The first paths of a record count in the cells around it: no more, so that these show all of them alike, and not
/// most of all those with the most noise.
constexpr float spread_paths = 64;
/// Rounds after which what was not looked up is not recent.
constexpr std::uint32_t recent_rounds = 256;
constexpr float young_rounds = 64; ///< after twice as many it is worth a third
/// Paths of all records together that are remembered.
constexpr float remembered_paths = 4096;
/// A path that brings the same but for rounding: relative.
constexpr float same_light = 1e-3f;
/// The least squared deviation, relative, that is expected of a record from what is coarser.
constexpr float least_off = 0.01f;
/// Paths are bright that bring so many times what is seen around. What they bring beyond that is rare, and smooth: it
/// is shown as a share of the rest, which is of as many paths as tell it.
constexpr float bright = 8;
constexpr float telling_paths = 1024;
/// Paths of a record from which on it tells paths that end there.
constexpr float told_paths = 64;
constexpr float telling_checks = 4; ///< fewer say little of a cell
/// Cells in one that is around them, of a surface.
constexpr float cells_around = 1 << (2 * parent_levels);
constexpr std::size_t most_asked = 1 << 15; ///< a thread and round
constexpr std::size_t recent_slots = 1 << 12;

/// What bright paths add, as a share of the rest.
float excess_of(GatheredLight const& gathered) {
    float const rest = luminance(gathered.sum.all);
    return rest > 0 ? gathered.excess / rest : 0;
}

/// Variance of a path, relative; at most what bright ones make of it.
float variance_of(GatheredLight const& gathered) {
    float const mean = luminance(gathered.sum.all) / gathered.paths;
    float const variance = gathered.squares / gathered.paths - mean * mean;
    return variance < bright * mean * mean ? std::max(variance / (mean * mean), 0.0f) : bright;
}

} // namespace

LightCache::LightCache(float scene_size, std::size_t most_bytes)
    : cells_(scene_size), most_records_(most_bytes / LightCells::bytes_a_record()) {
    looked_up_.prepare();
}

void LightCache::use(std::uint32_t record, bool is_nearest) {
    LightRecord& r = cells_[record];
    std::atomic_ref<std::uint32_t> used(r.used);
    if (used.load(std::memory_order_relaxed) != round_) {
        used.store(round_, std::memory_order_relaxed);
    }
    if (is_nearest) { // a lost count does not matter
        std::atomic_ref<std::uint32_t> uses(r.uses);
        uses.store(uses.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
    }
}

void LightCache::ask(LightPlace const& place, int level, CellKey const& key, LookedUp& own) {
    if (own.recent.empty()) {
        own.recent.resize(recent_slots);
        own.asked.reserve(most_asked);
    }
    CellKey& recent = own.recent[LightCells::hash_of(key) % recent_slots];
    if (recent == key || own.asked.size() == most_asked) {
        return;
    }
    recent = key;
    own.asked.push_back({place, level, key});
}

/// Adds the mean of the records around; returns `share`, or 0 where nothing is known. Asks for the one of its own cell.
/// For cells that have none yet speak coarser ones, so that there is no step beside what has just been made.
float LightCache::add_level(LightPlace const& place, int level, float share, bool asks, LookedUp& own,
                            IncomingLight& out) {
    IncomingLight sum;
    float weight = 0, lacking = 0;
    bool has_own = false;
    LightCells::Around& around = own.around[static_cast<std::size_t>(level)];
    CellKey const nearest =
        cells_.visit_around(place, level, around, [&](std::uint32_t number, float w, bool is_nearest) {
            if (!LightCells::is_record(number)) {
                lacking += w;
                return;
            }
            has_own = has_own || is_nearest;
            use(number, is_nearest);
            if (cells_[number].known) {
                sum.add(cells_[number].shown, w);
                weight += w;
            } else {
                lacking += w;
            }
        });
    if (asks && !has_own) {
        ask(place, level, nearest, own);
    }
    if (lacking > 0 && level > 0) {
        weight += add_level(place, level - 1, lacking, false, own, sum);
    }
    if (!(weight > least_weight)) {
        return 0;
    }
    out.add(sum, share / weight);
    return share;
}

bool LightCache::look_up(LightPlace const& place, float cell_size, IncomingLight& out) {
    LookedUp& own = looked_up_.local();
    own.any = true;
    float const exact = cells_.level_of(cell_size);
    int const level = static_cast<int>(exact);
    // One level alone serves three quarters of all sizes.
    float const finer =
        level < finest_cells ? std::clamp(4 * (exact - static_cast<float>(level)) - 1.5f, 0.0f, 1.0f) : 0;
    out = {};
    float weight = 0;
    if (finer < 1) {
        weight += add_level(place, level, 1 - finer, true, own, out);
    }
    if (finer > 0) {
        weight += add_level(place, level + 1, finer, true, own, out);
    }
    if (weight == 0 && everywhere_.paths > 0) {
        out.add(everywhere_.sum, (1 + excess_of(everywhere_)) / everywhere_.paths);
        return true;
    }
    if (!(weight > 0)) {
        return false;
    }
    IncomingLight const sum = out;
    out = {};
    out.add(sum, 1 / weight);
    return true;
}

bool LightCache::tells_of_others(LightRecord const& record, std::uint32_t pose) const {
    return record.known && record.gathered.paths >= told_paths && record.checked >= pose;
}

bool LightCache::find_known(LightPlace const& place, float cell_size, std::uint32_t pose, IncomingLight& out) const {
    int const finest = static_cast<int>(cells_.level_of(cell_size));
    int const coarsest = std::max(finest - parent_levels, 0);
    for (int level = finest; level >= coarsest; --level) { // its own cells alone: paths end all over these
        std::uint32_t const number = cells_.find(place, level);
        if (number != nothing && tells_of_others(cells_[number], pose)) {
            out = cells_[number].shown;
            return true;
        }
    }
    return false;
}

LightCache::Admitted LightCache::admit(std::size_t most) {
    bool looked_up = false;
    std::size_t count = 0;
    looked_up_.change_each([&](LookedUp& own) {
        looked_up = looked_up || std::exchange(own.any, false);
        count += own.asked.size();
        own.around.fill({});
    });
    std::size_t const step = (count + most - 1) / std::max<std::size_t>(most, 1); // of all parts of the picture alike
    std::size_t next = most > 0 ? 0 : count;
    looked_up_.change_each([&](LookedUp& own) {
        for (std::size_t i = 0; i < own.asked.size(); ++i) {
            Asked const& asked = own.asked[i];
            if (i == next) {
                cells_[make(asked.place, asked.level)].uses += 1;
                next += step;
            } else {
                cells_.await(asked.key);
            }
        }
        next -= own.asked.size();
        if (!own.asked.empty()) {
            own.asked.clear();
            std::ranges::fill(own.recent, CellKey{});
        }
    });
    Admitted admitted = count > 0 ? Admitted::some : Admitted::nothing;
    round_ += looked_up ? 1 : 0;
    if (cells_.count() > most_records_) {
        forget_oldest();
        admitted = Admitted::renumbered;
    }
    return admitted;
}

/// Makes the record of a cell and those around it, where there are none; returns its number.
std::uint32_t LightCache::make(LightPlace const& place, int level) {
    std::uint32_t const there = cells_.find(place, level);
    if (there != nothing) {
        return there;
    }
    LightRecord record;
    record.key = cells_.key_of(place, level);
    std::uint32_t const crowded = cells_.free_sheet(record.key);
    if (crowded != nothing) {
        return crowded;
    }
    record.place = place;
    record.parent = level >= parent_levels ? make(place, level - parent_levels) : nothing;
    record.used = round_;
    refresh(record);
    return cells_.add(record);
}

/// Keeps three quarters of the records: those that were used last, and what is around them.
void LightCache::forget_oldest() {
    std::vector<std::uint32_t> ages(cells_.count());
    for (std::uint32_t i = cells_.count(); i-- > 0;) { // what is around was made before it
        LightRecord const& record = cells_[i];
        ages[i] = record.used;
        if (record.parent != nothing) {
            cells_[record.parent].used = std::max(cells_[record.parent].used, record.used);
        }
    }
    std::size_t const most = most_records_ * 3 / 4;
    auto const oldest = ages.begin() + static_cast<std::ptrdiff_t>(ages.size() - most);
    std::ranges::nth_element(ages, oldest);
    std::vector<std::uint8_t> kept(cells_.count());
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < kept.size(); ++i) {
        kept[i] = cells_[i].used > *oldest || (cells_[i].used == *oldest && count < most) ? 1 : 0;
        count += kept[i];
    }
    cells_.keep(kept);
    in_use_.clear();
    next_renewed_ = 0;
}

void LightCache::note_unwatched() {
    round_ += recent_rounds;
}

bool LightCache::is_used(LightRecord const& record, Use use) const {
    return record.uses > 0 && (use == Use::any || record.used + recent_rounds > round_);
}

/// Lists the records that are used, and those around them.
void LightCache::list_in_use(Use use) {
    is_used_.assign(cells_.count(), 0);
    for (std::uint32_t i = cells_.count(); i-- > 0;) { // what is around was not made after it
        is_used_[i] = is_used_[i] != 0 || is_used(cells_[i], use) ? 1 : 0;
        if (is_used_[i] != 0 && cells_[i].parent != nothing) {
            is_used_[cells_[i].parent] = 1;
        }
    }
    in_use_.clear();
    next_renewed_ = 0;
    for (std::uint32_t i = 0; i < cells_.count(); ++i) {
        if (is_used_[i] != 0) {
            in_use_.push_back(i);
        }
    }
}

float LightCache::list_wanted(std::size_t most, Use use, std::vector<std::uint32_t>& out) {
    wanted_.clear();
    list_in_use(use);
    float squares = 0, weights = 0;
    for (std::uint32_t const i : in_use_) {
        LightRecord& record = cells_[i];
        if (record.parent != nothing && record.followed != cells_[record.parent].change) {
            float const change = cells_[record.parent].change;
            float const more = change - std::exchange(record.followed, change);
            outdate(record, more);
            record.change += more;
        }
        if (is_used(record, use)) {
            float const age = static_cast<float>(round_ - record.used) / young_rounds;
            float const weight = static_cast<float>(record.uses) / (1 + age);
            float const worth = weight * record.error * record.error;
            squares += worth;
            weights += weight;
            if (record.error > enough_error && record.gathered.paths < most_paths) {
                wanted_.emplace_back(-worth, i);
            }
        }
    }
    take_wanted(most, out);
    return weights > 0 ? std::sqrt(squares / weights) : 0;
}

void LightCache::list_unchecked(std::size_t most, Use use, std::vector<std::uint32_t>& out) {
    wanted_.clear();
    for (std::uint32_t i = 0; i < cells_.count(); ++i) {
        LightRecord const& record = cells_[i];
        if (is_used(record, use) && record.own > 0 && record.checked != pose_) {
            wanted_.emplace_back(-static_cast<float>(pose_ - record.checked), i);
        }
    }
    take_wanted(most, out);
}

/// Those of `wanted_` that come first.
void LightCache::take_wanted(std::size_t most, std::vector<std::uint32_t>& out) {
    std::size_t const count = std::min(most, wanted_.size());
    std::ranges::partial_sort(wanted_, wanted_.begin() + static_cast<std::ptrdiff_t>(count));
    out.resize(count);
    std::transform(wanted_.begin(), wanted_.begin() + static_cast<std::ptrdiff_t>(count), out.begin(),
                   [](auto const& wanted) { return wanted.second; });
}

void LightCache::check(std::uint32_t number, float first) {
    LightRecord& record = cells_[number];
    record.checked = pose_;
    float const before = std::exchange(record.first, first);
    bool const same = std::abs(first - before) <= same_light * std::max(first, before);
    float const shade = std::max(luminance(record.shown.all), 1e-20f);
    std::uint32_t const around = record.parent == nothing ? number : record.parent;
    LightRecord& cell = cells_[around];
    cell.checks += 1;
    float const apart = same ? 0.0f : std::clamp((first - before) / shade, -1.0f, 1.0f);
    cell.changed += apart;
    cell.changed_squares += apart * apart;
    if (cell.checks >= telling_checks || record.parent == nothing) {
        judge_checks(around);
    }
}

void LightCache::end_checks() {
    for (std::uint32_t i = cells_.count(); i-- > 0;) { // what is around was not made after it
        LightRecord& cell = cells_[i];
        if (cell.checks >= telling_checks || (cell.checks > 0 && cell.parent == nothing)) {
            judge_checks(i);
        } else if (cell.checks > 0) {
            cells_[cell.parent].checks += std::exchange(cell.checks, 0.0f);
            cells_[cell.parent].changed += std::exchange(cell.changed, 0.0f);
            cells_[cell.parent].changed_squares += std::exchange(cell.changed_squares, 0.0f);
        }
    }
}

/// Takes the mean of checks as what has changed: single paths differ a lot where something small moves, which changes
/// little.
void LightCache::judge_checks(std::uint32_t number) {
    LightRecord& cell = cells_[number];
    cell.checked = pose_;
    float const mean = cell.changed / cell.checks;
    float const spread = std::max(cell.changed_squares / cell.checks - mean * mean, 0.0f);
    float change = std::max(mean * mean - spread / std::max(cell.checks - 1, 1.0f), 0.0f);
    cell.checks = cell.changed = cell.changed_squares = 0;
    cell.change += change;
    for (std::uint32_t at = number; at != nothing && change > 0; at = cells_[at].parent, change /= cells_around) {
        outdate(cells_[at], change);
    }
}

/// Of n paths with a relative variance of about 1, gathered before the light has changed by `change` (squared,
/// relative), as many are left as have the same squared error.
void LightCache::outdate(LightRecord& record, float change) {
    if (record.gathered.paths > 0 && change > 0) {
        float const left = 1 / (1 + record.gathered.paths * change);
        record.gathered.scale(left);
        record.told *= left;
        refresh(record);
    }
}

void LightCache::add(std::uint32_t number, GatheredLight const& gathered, float first) {
    LightRecord& record = cells_[number];
    bool const spreads = record.told < spread_paths;
    if (record.own == 0) {
        record.first = first;
        record.checked = pose_;
    }
    record.own += gathered.paths;
    if (spreads) {
        everywhere_.scale(remembered_paths / std::max(everywhere_.paths, remembered_paths));
        everywhere_.add(gathered);
        everywhere_.sum.lean = Vec3(0); // of surfaces that face all ways
    }
    std::array<std::uint32_t, finest_cells / parent_levels + 1> chain;
    std::size_t count = 0;
    for (std::uint32_t at = number; at != nothing && (spreads || at == number); at = cells_[at].parent) {
        cells_[at].gathered.add(gathered);
        cells_[at].told += spreads ? gathered.paths : 0;
        cells_[at].checked = cells_[at].checked == 0 ? pose_ : cells_[at].checked;
        chain[count++] = at;
    }
    while (count > 0) {
        refresh(cells_[chain[--count]]);
    }
}

float LightCache::bright_path(std::uint32_t number) const {
    for (int up = 0; up < 2 && number != nothing; ++up) { // farther: what is dark by chance is not to stay so
        number = cells_[number].parent;
    }
    float shade = 0;
    if (number != nothing && cells_[number].known) {
        shade = luminance(cells_[number].shown.all);
    } else if (everywhere_.paths > 0) {
        shade = luminance(everywhere_.sum.all) / everywhere_.paths;
    }
    return shade > 0 ? bright * shade : INFINITY;
}

/// What coarser records show at a record's place; false where they know nothing.
bool LightCache::find_coarse(LightRecord const& record, IncomingLight& out, float& excess) const {
    out = {};
    excess = excess_of(everywhere_);
    if (record.parent == nothing) {
        return false;
    }
    LightRecord const& parent = cells_[record.parent];
    float weight = 0, excesses = 0;
    LightCells::Around around;
    cells_.visit_around(record.place, LightCells::level_in(parent.key), around,
                        [&](std::uint32_t number, float w, bool) {
                            if (LightCells::is_record(number) && cells_[number].known) {
                                out.add(cells_[number].shown, w / (1 + cells_[number].excess));
                                excesses += w * cells_[number].excess;
                                weight += w;
                            }
                        });
    if (weight > least_weight) {
        IncomingLight const sum = std::exchange(out, {});
        out.add(sum, 1 / weight);
        excess = excesses / weight;
    } else if (parent.known) {
        out.add(parent.shown, 1 / (1 + parent.excess));
        excess = parent.excess;
    }
    return weight > least_weight || parent.known;
}

/// Shows w * own + (1 - w) * coarse, w = t^2 / (t^2 + v / n): v / n is the squared error of the mean of its n paths,
/// t^2 how far it may be off what is coarser. Where light comes from as near as R it changes by dx / R [Ward 1988].
void LightCache::refresh(LightRecord& record) {
    constexpr float typical_offset = 0.5f; // of a record from what is coarser, in cells of the parent
    GatheredLight const& own = record.gathered;
    LightRecord const* const parent = record.parent == nothing ? nullptr : &cells_[record.parent];
    GatheredLight const& around = parent != nullptr && parent->gathered.paths > 0 ? parent->gathered : everywhere_;
    IncomingLight coarse;
    bool const is_in_known = find_coarse(record, coarse, record.excess);
    if (!is_in_known && around.paths > 0) {
        coarse.add(around.sum, 1 / around.paths);
    }
    record.known = own.paths > 0 || is_in_known;
    record.shown = {};
    record.shown.add(coarse, 1 + record.excess);
    record.error = 1;
    if (!(own.paths > 0)) {
        return;
    }
    record.excess += own.paths / (own.paths + telling_paths) * (excess_of(own) - record.excess);
    float error = variance_of(own) / own.paths; // squared, relative
    float share = 1;
    if (around.paths > 0) {
        // Places that missed rare bright paths have little variance of their own.
        error = std::max(error, variance_of(around) / own.paths);
        float const bound =
            is_in_known ? typical_offset * cells_.size(LightCells::level_in(parent->key)) * own.nearness / own.paths
                        : 1;
        float const off = std::clamp(bound * bound, least_off, 1.0f);
        share = off / (off + error);
    }
    record.shown = {};
    record.shown.add(coarse, (1 - share) * (1 + record.excess));
    record.shown.add(own.sum, share / own.paths * (1 + record.excess));
    record.error = std::min(std::sqrt(share * error), 1.0f);
}

/// Brings the next of the records that are in use up to date with what is coarser.
void LightCache::renew(std::size_t count) {
    for (; count > 0 && next_renewed_ < in_use_.size(); --count) {
        refresh(cells_[in_use_[next_renewed_++]]);
    }
    if (next_renewed_ == in_use_.size()) {
        next_renewed_ = 0;
    }
}

} // namespace framelet
