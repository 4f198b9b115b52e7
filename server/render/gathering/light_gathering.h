// Gathers light for the records of the light cache. In: a posed scene, records that are wanted. Out: what paths from
// their places have brought. The numbers of a record's paths are fixed by its cell and their count.
#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "server/render/cache/light_cache.h"
#include "server/render/gathering/learning_share.h"
#include "server/render/path/path_light.h"

namespace framelet {

/// Sixteen paths from a place of the light cache.
struct PlaceGathering {
    LightPlace place;
    std::uint32_t seed = 0; ///< of their random numbers
    std::uint32_t first = 0; ///< number of the first, among those of the place
    float bright = 0; ///< luminance from which on what a path brings is kept apart
};

struct GatheredPacket {
    GatheredLight light;
    float first = 0; ///< luminance that the first path has brought
};

/// Light by which paths may end early.
struct KnownLight {
    LightCache const* cache = nullptr; ///< null: they do not
    std::uint32_t pose = 0; ///< of the scene, that it was checked in
};

/// Follows paths from a place, on the calling thread.
GatheredPacket gather_packet(PathLight const& light, PlaceGathering const& wanted, KnownLight const& known = {});

class LightGathering {
public:
    /// Both must outlive this.
    LightGathering(PathLight const& light, LightCache& cache);

    /// To be called when the scene has another pose.
    void note_pose();

    /// False once all that was looked at lately is good enough. May be asked at any time.
    bool is_learning() const { return is_learning_; }

    /// Plans up to `most_paths` paths for the records that are wanted most; where the scene has moved, some of them
    /// check whether the light has changed. Returns in how many packets; none: all that is looked at is good enough.
    std::size_t plan(std::size_t most_paths, LightCache::Use use);
    /// Follows one of the packets that were planned. Others may be followed, and the cache be looked up, meanwhile.
    void follow(std::size_t packet);
    /// Where a packet's paths begin, for somebody else to follow them; nothing: it is for this process alone.
    std::optional<PlaceGathering> order(std::size_t packet) const;
    /// Takes in what somebody else has made of that; in place of `follow`.
    void take_gathered(std::size_t packet, GatheredPacket const& gathered) { gathered_[packet] = gathered; }
    /// Notes that threads have waited for somebody else's packets, seconds: these cost that much.
    void note_waited(double seconds) { took_.fetch_add(seconds, std::memory_order_relaxed); }
    /// Teaches the cache what all the packets have brought. Nothing may look up meanwhile, nor while paths are planned.
    /// Beside them so many samples took so many processor seconds. Returns how many paths there were.
    std::size_t finish(std::size_t samples = 0, double samples_took = 0);

    /// All of that, in parallel on the calling TBB arena. Returns how many paths that took.
    std::size_t work(std::size_t most_paths, LightCache::Use use = LightCache::Use::any, std::size_t samples = 0,
                     double samples_took = 0);

    /// Paths that are as many as there is time for beside so many samples.
    std::size_t paths_beside(std::size_t samples) const { return share_.paths_beside(samples); }
    /// Paths that take so many processor seconds, about.
    std::size_t paths_in(double seconds) const { return share_.paths_in(seconds); }

private:
    void refill(LightCache::Use use);
    void follow_check(std::size_t packet);

    PathLight const& light_;
    LightCache& cache_;
    bool moved_ = false; ///< since the last time that all records were found to be checked
    std::size_t idle_ = 0; ///< times that nothing was wanted
    std::atomic<bool> is_learning_ = true;
    std::vector<std::uint32_t> wanted_, unchecked_; ///< records in the order in which they are worked on
    std::size_t next_wanted_ = 0, next_unchecked_ = 0; ///< those before were worked on
    std::vector<std::uint32_t> gathers_, checks_; ///< records of what is planned
    std::vector<GatheredPacket> gathered_; ///< what came of `gathers_`
    LearningShare share_;
    std::atomic<double> took_ = 0; ///< processor seconds of the packets that were followed
    std::vector<float> checked_; ///< luminance of the first paths of `checks_`
};

} // namespace framelet
