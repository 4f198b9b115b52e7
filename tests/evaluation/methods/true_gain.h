// Computes by how much the true error of a picture falls where a tile is rendered anew, for all tiles of all spacings.
// In: the scene, when tiles are rendered and when they are looked at, the picture that the viewer would show then
// without any of them. Out: the tiles that are worth most.
#pragma once

#include <vector>

#include "common/image.h"
#include "server/stream/layers/shape_feed.h"
#include "tests/evaluation/bench_scene.h"
#include "tests/evaluation/cost_table.h"

namespace framelet::bench {

class TrueGain {
public:
    /// `coarsest`: greatest spacing, pixels from sample to sample: 1, 2 or 4. It is bounded since for each single batch
    /// coarse tiles seem to be worth more than they are in the long run.
    TrueGain(Viewport viewport, CostTable const& costs, int coarsest);

    /// Renders the tiles of one time and the reference of another, unless both are those of the last look, and lets a
    /// viewer move each spacing's tiles to the camera and the scene time of the reference. Samples are `coarsest` to
    /// 1/2 pixels apart, 1/4 as well from the second look at what does not move. `held`: the viewer's picture at time
    /// `seen`.
    void look(BenchScene& scene, SceneTime rendered, SceneTime seen, double now, Picture const& held);

    struct Chosen {
        Framelet const* rendered = nullptr;
        DisplayFramelet const* displayed = nullptr;
        std::uint64_t segments = 0;
    };
    /// Chooses at most `most` tiles greedily, each for what it brings beside those before it, since every framelet has
    /// as many samples. Chooses none that brings nothing. Valid until the next look.
    std::vector<Chosen> choose(std::size_t most);

private:
    /// All tiles of one depth.
    struct Level {
        int depth = 0;
        std::vector<Tile> tiles;
        std::vector<Framelet> rendered;
        std::vector<DisplayFramelet> displayed;
        std::vector<std::uint64_t> segments;
        std::vector<float> errors; ///< squared errors of the picture made of these tiles, by pixel
        std::vector<double> gains; ///< error that each tile would take away, by tile
        ShapeFeed shapes;
    };

    void render(BenchScene const& scene, Level& level) const;
    void compare(BenchScene const& scene, SceneTime rendered, SceneTime seen, double now, Level& level) const;
    template <class Look>
    void each_pixel(Tile tile, Look&& look) const;
    void take(Level const& level, Tile tile);
    double gain_of(Level const& level, Tile tile) const;

    ImagePlane const plane_;
    CostTable const costs_;
    std::vector<Level> levels_; ///< coarse to fine
    Picture reference_;
    std::vector<float> held_errors_;
    std::vector<std::int8_t> depths_; ///< depth of the finest tile chosen at each pixel; -1: none
    Camera camera_; ///< camera for which the tiles were rendered
    ScenePose pose_;
    int still_looks_ = -1; ///< repeated looks at the same still view; -1: none yet
};

} // namespace framelet::bench
