// The paths of light of one batch, or of a moment in which nobody waits: traced by this process, and by its workers
// where it has some. In: a posed scene, tiles, packets that a gathering has planned. Out: what the paths bring: through
// tiles the same bits whoever has traced them; packets of workers do not end where light is known.
#pragma once

#include <span>
#include <vector>

#include "server/render/gathering/light_gathering.h"
#include "server/workers/worker_pool.h"

namespace framelet {

class PathRound {
public:
    /// Where and when paths are traced: workers pose their scene for that.
    struct Moment {
        SceneTime scene_time = 0;
        NumberedView view; ///< of the tiles
    };
    /// Begins with paths through these tiles and with the packets that `gathering` (null: none) has planned; `workers`
    /// (null: there are none) are at them from now on. All is to stay as it is until `finish`.
    void begin(WorkerPool* workers, PathLight const& light, Moment const& moment, std::vector<TilePath> tiles,
               LightGathering* gathering, std::size_t packets);
    /// Traces what is left, on the calling TBB arena, and waits until all of it is traced. What packets have brought is
    /// the gathering's then.
    void finish();

    /// What was brought by the paths through tiles, in their order.
    std::span<TileLight const> light() const { return std::span(light_).first(tiles_.size()); }

private:
    /// Some of `tiles_`, or of `packets_`.
    struct Chunk {
        bool is_of_tiles = true;
        std::size_t first = 0, count = 0;
    };

    void trace(std::size_t index);
    bool take(Chunk const& chunk, PathAnswer const& answer);
    void share();

    WorkerPool* workers_ = nullptr;
    PathLight const* path_light_ = nullptr;
    LightGathering* gathering_ = nullptr;
    Moment moment_;
    std::vector<TilePath> tiles_;
    std::vector<TileLight> light_; ///< as many as a batch ever had
    std::vector<std::size_t> packets_; ///< those that may be shared first
    std::size_t shared_packets_ = 0; ///< how many these are
    std::vector<Chunk> chunks_; ///< that are shared with workers; empty: nothing is
};

} // namespace framelet
