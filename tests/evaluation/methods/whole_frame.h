// Whole frames in turn, one sample a pixel: what every `framed` method renders. In: a posed scene and a view. Out: the
// framelets of one frame as they are displayed, and what they cost.
#pragma once

#include <span>
#include <vector>

#include "tests/evaluation/codecs/delivery_rate.h"
#include "tests/evaluation/method.h"

namespace framelet::bench {

class WholeFrame {
public:
    explicit WholeFrame(MethodSetup const& setup);

    /// Renders every pixel of the view. Seconds: render, and the tone curve under `encode`.
    ServerStep render(StepInput const& input);
    /// One for each tile of the picture, from the beginning on; before `render` only their tiles are set.
    std::vector<DisplayFramelet> const& framelets() const { return displayed_; }
    /// The same before exposure, with depths and bodies.
    std::vector<Framelet> const& rendered() const { return rendered_; }
    /// The same as a picture.
    Picture const& picture();

    std::size_t pixels() const { return pixels_; }

    /// Bytes that the encoder may make of the frame last rendered, for a link that it shall neither fill nor leave
    /// idle: from what the answers say and from how long a frame takes. `encode_seconds`: what encoding costs,
    /// calibrated.
    double budget(StepInput const& input, ServerStep const& rendered, double encode_seconds);

    /// The message of such an access unit, which says of when it is.
    static std::vector<std::byte> timed(SceneTime time, std::span<std::byte const> access_unit);
    /// Takes such a message apart: sets `time`, returns the access unit.
    static std::span<std::byte const> untimed(std::span<std::byte const> message, SceneTime& time);

private:
    CostTable costs_;
    double machine_;
    DeliveryRate rate_;
    ImagePlane plane_;
    std::vector<Tile> tiles_;
    std::vector<Framelet> rendered_;
    std::vector<DisplayFramelet> displayed_;
    Picture picture_;
    std::size_t pixels_;
};

/// Writes a framelet of one sample a pixel to its place.
void place_framelet(DisplayFramelet const& framelet, ImagePlane const& plane, Picture& picture);

/// Reads the framelet's samples from there; beyond the picture's border its last pixels repeat.
void take_framelet(Picture const& picture, ImagePlane const& plane, DisplayFramelet& framelet);

} // namespace framelet::bench
