#include "server/render/gathering/light_gathering.h"

#include <algorithm>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <tbb/parallel_for.h>

#include "common/laps.h"
#include "server/render/flush_denormals.h"
#include "server/render/light/luminance.h"
#include "server/render/path/path_random.h"
#include "server/render/path/path_tracing.h"
#include "server/render/prepared/light_frame.h"

namespace framelet {
namespace {

/// Width of textures that a ray sees, by its length: many rays are averaged.
constexpr float gather_slope = 0.1f;
/// Bounces after which roulette begins: what is left is smooth.
constexpr int sure_bounces = 1;
/// One path of so many checks a record, while the scene moves.
constexpr std::size_t check_share = 3;
/// Records that are listed at once: looking at all of them takes as long as some paths.
constexpr std::size_t listed = 512;
/// Where nothing was wanted and nothing has changed they are looked at again after so many plans.
constexpr std::size_t idle_plans = 16;
/// Records that are made at most for each that there is time to gather paths for: more would show what those around
/// them do.
constexpr std::size_t made_share = 2;
/// Records that are renewed for each that has new paths.
constexpr std::size_t renewed_share = 8;

/// Numbers of a record's paths.
std::uint32_t seed_of(CellKey const& key, std::uint32_t seed) {
    seed = hashed(seed, key.kind);
    for (std::int32_t const c : key.cell) {
        seed = hashed(seed, static_cast<std::uint32_t>(c));
    }
    return seed;
}

/// Paths from places of records, one a lane.
struct Gathering {
    LaneVec3 position, normal;
    PathNumbers numbers;
    GatheredLanes brought;

    /// Lets path `number` from a place be a lane's.
    void set(int lane, LightFrame const& frame, LightPlace const& place, std::uint32_t seed, std::uint32_t number) {
        position.set(lane, frame.linear * place.position + frame.translation);
        normal.set(lane, glm::normalize(frame.rotation * place.normal));
        numbers.pixel_seed[lane] = seed;
        numbers.sample[lane] = number;
    }
    void follow(PathLight const& light, LaneMask active, KnownLight const& known = {}) {
        Footprint footprint{};
        footprint.slope.fill(gather_slope);
        PathOptions options = light.options();
        options.sure_bounces = sure_bounces;
        options.known = known.cache;
        options.known_pose = known.pose;
        gather_light(light.scene(), options, position, normal, active, footprint, numbers, brought);
    }
};

/// Takes up to `most` of the next records of a list.
void take(std::vector<std::uint32_t> const& from, std::size_t& next, std::size_t most,
          std::vector<std::uint32_t>& out) {
    std::size_t const count = std::min(most, from.size() - next);
    out.assign(from.begin() + static_cast<std::ptrdiff_t>(next),
               from.begin() + static_cast<std::ptrdiff_t>(next + count));
    next += count;
}

std::size_t packets_of(std::size_t paths) {
    return (paths + lanes - 1) / lanes;
}

} // namespace

GatheredPacket gather_packet(PathLight const& light, PlaceGathering const& wanted, KnownLight const& known) {
    FlushDenormals const flush;
    Gathering gathering;
    LightFrame const frame = light_frame(light.scene().scene, wanted.place.frame);
    for (int i = 0; i < lanes; ++i) {
        gathering.set(i, frame, wanted.place, wanted.seed, wanted.first + static_cast<std::uint32_t>(i));
    }
    gathering.follow(light, all_lanes, known);
    GatheredLanes const& brought = gathering.brought;
    Vec3 const facet = gathering.normal.get(0);
    GatheredPacket out;
    out.light.paths = lanes;
    for (int i = 0; i < lanes; ++i) {
        Vec3 const lean = brought.lean.get(i);
        float const shade = luminance(brought.all.get(i));
        float const part = shade > wanted.bright ? wanted.bright / shade : 1;
        out.light.sum.add({brought.all.get(i) * part, brought.reflected.get(i) * part,
                           (lean - facet * glm::dot(facet, lean)) * part, brought.open[i]},
                          1);
        out.light.excess += shade * (1 - part);
        out.light.squares += shade * part * shade * part;
        out.light.nearness += brought.nearness[i];
    }
    out.light.sum.lean = glm::transpose(frame.rotation) * out.light.sum.lean;
    out.first = luminance(brought.all.get(0));
    return out;
}

LightGathering::LightGathering(PathLight const& light, LightCache& cache) : light_(light), cache_(cache) {}

void LightGathering::note_pose() {
    cache_.note_pose();
    moved_ = true;
    idle_ = 0;
}

/// Lists records anew where all that were listed have been worked on.
void LightGathering::refill(LightCache::Use use) {
    bool const looks = idle_ % idle_plans == 0;
    if (next_unchecked_ == unchecked_.size() && (moved_ || looks)) { // what was not in use in this pose may be now
        cache_.list_unchecked(listed, use, unchecked_);
        next_unchecked_ = 0;
        if (std::exchange(moved_, !unchecked_.empty()) && !moved_) {
            cache_.end_checks();
        }
    }
    if (next_wanted_ == wanted_.size() && looks) {
        share_.note_error(cache_.list_wanted(listed, use, wanted_));
        next_wanted_ = 0;
    }
    idle_ = next_wanted_ == wanted_.size() ? idle_ + 1 : 0;
}

std::size_t LightGathering::plan(std::size_t most_paths, LightCache::Use use) {
    LightCache::Admitted const admitted = cache_.admit(made_share * packets_of(most_paths));
    if (admitted == LightCache::Admitted::renumbered) {
        wanted_.clear();
        unchecked_.clear();
        next_wanted_ = next_unchecked_ = 0;
    }
    if (admitted != LightCache::Admitted::nothing) {
        idle_ = 0;
    }
    refill(use);
    is_learning_ = moved_ || idle_ <= idle_plans;
    take(unchecked_, next_unchecked_, most_paths / check_share, checks_);
    take(wanted_, next_wanted_, (most_paths - checks_.size()) / lanes, gathers_);
    checked_.resize(checks_.size());
    gathered_.resize(gathers_.size());
    return packets_of(checks_.size()) + gathers_.size();
}

void LightGathering::follow(std::size_t packet) {
    Laps laps;
    if (auto const wanted = order(packet)) {
        // Paths end at surfaces of which the light is known. The first is what checks follow again: by itself.
        std::uint32_t const pose = cache_.records()[gathers_[packet]].checked;
        gathered_[packet] = gather_packet(light_, *wanted, {wanted->first > 0 ? &cache_ : nullptr, pose});
    } else {
        follow_check(packet - gathers_.size());
    }
    took_.fetch_add(laps.lap(), std::memory_order_relaxed);
}

std::optional<PlaceGathering> LightGathering::order(std::size_t packet) const {
    if (packet >= gathers_.size()) { // a check is of many places, and compared with what was found here
        return std::nullopt;
    }
    std::uint32_t const number = gathers_[packet];
    LightRecord const& record = cache_.records()[number];
    return PlaceGathering{record.place, seed_of(record.key, light_.options().seed),
                          static_cast<std::uint32_t>(record.own), cache_.bright_path(number)};
}

/// Follows the first paths of sixteen records again.
void LightGathering::follow_check(std::size_t packet) {
    FlushDenormals const flush;
    std::size_t const begin = packet * lanes;
    int const count = static_cast<int>(std::min<std::size_t>(lanes, checks_.size() - begin));
    Gathering gathering;
    for (int i = 0; i < lanes; ++i) { // unused lanes repeat the last
        LightRecord const& record = cache_.records()[checks_[begin + static_cast<std::size_t>(std::min(i, count - 1))]];
        gathering.set(i, light_frame(light_.scene().scene, record.place.frame), record.place,
                      seed_of(record.key, light_.options().seed), 0);
    }
    gathering.follow(light_, all_lanes >> (lanes - count));
    for (int i = 0; i < count; ++i) {
        checked_[begin + static_cast<std::size_t>(i)] = luminance(gathering.brought.all.get(i));
    }
}

std::size_t LightGathering::finish(std::size_t samples, double samples_took) {
    std::size_t const paths = checks_.size() + gathers_.size() * lanes;
    share_.note(samples, samples_took, paths, took_.exchange(0));
    for (std::size_t i = 0; i < checks_.size(); ++i) {
        cache_.check(checks_[i], checked_[i]);
    }
    for (std::size_t i = 0; i < gathers_.size(); ++i) {
        cache_.add(gathers_[i], gathered_[i].light, gathered_[i].first);
    }
    cache_.renew(renewed_share * gathers_.size());
    return paths;
}

std::size_t LightGathering::work(std::size_t most_paths, LightCache::Use use, std::size_t samples,
                                 double samples_took) {
    std::size_t const packets = plan(most_paths, use);
    tbb::parallel_for(std::size_t{0}, packets, [&](std::size_t i) { follow(i); });
    return finish(samples, samples_took);
}

} // namespace framelet
