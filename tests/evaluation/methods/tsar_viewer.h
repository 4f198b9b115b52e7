// The viewer's half of `tsar`: blends cached framelets of many ages into one picture, as [Stephens 2011] section 4.2
// does it. In: framelets. Out: the picture, all of it anew each time.
#pragma once

#include <array>
#include <vector>

#include "common/framelet/framelet.h"
#include "common/image.h"

namespace framelet::bench {

/// Amount of work done, for which the virtual clock charges.
struct BlendWork {
    double pixels = 0; ///< pixels that went through age, smoothing and normalisation
    double contributions = 0; ///< contributions of four samples each to a pixel
};

class TsarViewer {
public:
    explicit TsarViewer(ImagePlane plane);

    /// Puts the framelets into the cache and draws. `time`: seconds, by the server's clock; does not go back.
    BlendWork show(std::vector<DisplayFramelet> const& framelets, double time, SceneTime scene_time);

    Picture const& picture() const { return picture_; }
    /// Scene time of what the pixels show, mean over them.
    double mean_scene_time() const { return mean_scene_time_; }
    std::size_t framelet_count() const { return held_.size(); }

private:
    struct Held {
        Tile tile;
        float time = 0;
        float scene_time = 0;
        PixelRect extent; ///< pixels whose centres lie in the tile enlarged by half a sample spacing
        std::array<std::array<float, framelet_samples>, 3> linear; ///< red, green, blue: linear light, in rows
    };
    /// Samples of a framelet that a pixel's column or row takes, and the weight of each.
    struct Taps {
        int first = 0;
        int count = 0;
        std::array<float, 8> weights{};
    };

    void draw_ages();
    void smooth_ages();
    double accumulate(int top, int bottom, std::vector<std::uint8_t>& used);
    Taps taps(Tile tile, int origin, int pixel) const;
    void normalise();

    ImagePlane const plane_;
    std::vector<Held> held_; ///< oldest first
    std::vector<float> newest_, smooth_, sums_; ///< one a pixel, `sums_` five: colour, scene time and weight
    float half_step_ = 0; ///< seconds
    Picture picture_;
    double mean_scene_time_ = 0;
};

} // namespace framelet::bench
