// What stays where it is in the picture while the surfaces on which it is seen go by: a shadow below a car that the
// camera follows. A viewer that moves what it holds would take it along with the ground. In: rendered framelets, what
// changed of them, their moment. Out: which these are, and shapes that stay in their place.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/framelet_shape.h"
#include "server/response/place_model.h"
#include "server/schedule/meeting_bodies.h"

namespace framelet {

/// How fast what is seen at samples [first, first + count) is carried through the picture by the camera's motion and
/// that of bodies, pixels a second: the mean of some of them; 0 where the viewer moves nothing or no
/// scene time passes. Finite.
float carried_speed(Framelet const& framelet, ImagePlane const& plane, RenderedMoment const& moment, std::size_t first,
                    std::size_t count);

/// How much has changed of what was seen, and how much that motion would have changed: mean squared differences.
struct CarriedChange {
    float seen = 0;
    float expected = 0;
};

/// Of a place whose content was carried at `speed`, pixels a second.
CarriedChange carried_change(PlaceModel const& model, Observation const& seen, float speed);

/// True where much should have changed, and hardly anything has.
bool stays(CarriedChange const& change);

/// Lets the layers and loose samples that nothing carries go with the camera as it goes now: they stay in the picture
/// while scene time runs on. Nothing where it does not, nor where the camera goes as only a cut makes it go.
void bind_to_picture(Tile tile, ImagePlane const& plane, RenderedMoment const& moment, FrameletShape& shape);

} // namespace framelet
