// The light of a served scene by paths: one path for each sample while anything moves, and sums of more of them for a
// picture at rest. In: a prepared scene, tiles, how many paths. Out: radiance, and what is left of the noise.
//
// The numbers of a path are fixed by the place of its sample and the number of the path, so that each viewer of a
// picture at rest gets the same bytes in the end.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "common/color.h"
#include "common/framelet/framelet.h"
#include "server/render/light/light_options.h"
#include "server/render/path/path_options.h"

namespace framelet {

struct PathScene;
struct PreparedScene;

/// Sizes of the lights of a scene that fills `bounds`.
LampSizes lamp_sizes(LightOptions const& light, Bounds const& bounds);

class PathLight {
public:
    /// `scene` must outlive this, and stay where it is.
    PathLight(PreparedScene const& scene, PathOptions const& options);
    ~PathLight();
    PathLight(PathLight const&) = delete;
    PathLight& operator=(PathLight const&) = delete;

    /// To be called when the scene has another pose.
    void update();
    PathScene const& scene() const { return *scene_; }
    PathOptions const& options() const { return options_; }

private:
    std::unique_ptr<PathScene> scene_;
    PathOptions options_;
};

/// Sums over the paths of each sample of a tile, in Morton order.
struct TileSums {
    int paths = 0; ///< of each sample
    std::array<float, framelet_samples> red{}, green{}, blue{}; ///< radiance
    std::array<float, framelet_samples> squares{}; ///< of its luminance
};

/// Sums of a picture at rest, with a sample a pixel.
class PathSums {
public:
    static constexpr std::size_t bytes_per_pixel = sizeof(TileSums) / framelet_samples + 1; ///< rounded up

    /// Makes room for a picture, where there is none for one of this size. Not to be called while sums are used.
    void hold(ImagePlane const& plane);
    /// The sums of a tile of the depth of pixels. Other tiles' may be used on other threads meanwhile.
    TileSums& operator[](Tile tile);
    /// Forgets all, and gives the memory back.
    void clear() { *this = {}; }
    bool empty() const { return tiles_.empty(); }

private:
    ImagePlane plane_;
    int columns_ = 0;
    std::vector<TileSums> tiles_; ///< row by row
};

/// What one path of each sample of a tile brings, in Morton order.
struct TileLight {
    std::array<float, framelet_samples> red, green, blue; ///< radiance
};

/// Traces path number `path` of each sample of a tile. `view` is of the plane's viewport.
void trace_tile(PathLight const& light, ViewRays const& view, ImagePlane const& plane, Tile tile, int path,
                TileLight& out);
/// Makes ready for paths until there are `paths` of each sample: sums of as many or more begin anew. Returns the number
/// of the first that is to be added.
int first_to_add(TileSums& sums, int paths);
/// Adds what the next path of each sample has brought.
void add_path(TileLight const& light, TileSums& sums);
/// Sets the radiance of the samples to the means of their paths, of which there are some.
void set_means(TileSums const& sums, Framelet& out);

/// Mean squared standard error of a sample of the tile, as luminance in the display's encoding, [0, 1]. `exposure`
/// multiplies radiance. Infinite for fewer paths than tell.
float squared_error(TileSums const& sums, DisplayTransform const& transform);

} // namespace framelet
