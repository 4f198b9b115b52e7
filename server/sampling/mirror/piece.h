// Pieces: small parts of framelets, each of one layer, by which the server remembers what a viewer holds without its
// colours. In: a framelet as it is shown, and the shape by which the viewer moves it. Out: pieces.
#pragma once

#include <cstdint>
#include <vector>

#include "common/framelet/framelet.h"
#include "common/framelet/framelet_shape.h"
#include "common/math.h"

namespace framelet {

struct Piece {
    Vec2 centre{0}; ///< in the picture of its moment, pixels
    Vec2 half_side{0}; ///< of the rectangle that it covers there, pixels
    float inverse_depth = 0; ///< at the centre, 1 / metres; finite, >= 0
    Vec2 depth_slope{0}; ///< slope of the inverse depth, 1 / metres a pixel
    float error = 0; ///< most by which inverse depths of its samples may differ, 1 / metres
    float spacing = 1; ///< of its samples, pixels
    float luma = 0; ///< mean, display-encoded, [0, 1]
    Vec2 slope{0}; ///< slope of the luma, luma a pixel
    /// Energy of the detail between samples a pixel apart, mean squared luma. Between samples `s` pixels apart it is
    /// about s times as much, as it is of edges, which are most of a picture.
    float detail = 0;
    float light = 0; ///< as of `Framelet::light`, mean; 0: not known
    float decorrelation = 0; ///< pixels of spacing a second: see `common/framelet/sample_worth.h`
    SceneTime scene_time = 0; ///< when it was rendered
    Drift drift; ///< at the centre
    BodyNumber body = static_body;
    bool is_outlier : 1 = false; ///< its samples lie on no layer
    bool moves : 1 = false; ///< something in its framelet may move, being on a body or deforming
    bool is_brief : 1 = false; ///< as of `FrameletShape`: the viewer holds it with what stands
    bool rests : 1 =
        false; ///< nothing in its framelet moves about its scene time: the viewer holds it with what stands
    bool is_replaced : 1 = false; ///< a newer framelet lies in its place: it is held no longer
    bool is_supersampled : 1 = false; ///< its samples are means of four rays each
    bool reflects : 1 = false; ///< shows a reflection somewhere, which moves otherwise than the surface
    SentTile of; ///< the framelet that it is part of
};

/// Appends the pieces of a framelet of a scene time and a batch: for each layer, squares of 4 .. 16 pixels or what of
/// them lies on it; the outliers of a square are split in a near and a far part. `decorrelation` stays 0. All
/// numbers are finite where those of the shape are.
void cut_pieces(Framelet const& rendered, DisplayFramelet const& shown, FrameletShape const& shape,
                ImagePlane const& plane, SceneTime scene_time, std::uint64_t batch, std::vector<Piece>& pieces);

/// The square of its framelet that a piece was cut from, alone or with others; pixels, also beyond the viewport.
PixelRect part_of(Piece const& piece, ImagePlane const& plane);

} // namespace framelet
