// Decides whether pictures are painted on the graphics card. In: what the user wants, what OpenGL says of its renderer.
// Out: a canvas, or none and why.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "client/gpu/gpu_canvas.h"
#include "client/painter.h"

namespace framelet {

/// True where OpenGL's renderer of this name is a program on the processor, which the painter on it is quicker than.
bool is_software(std::string_view renderer);

struct CanvasChoice {
    std::unique_ptr<GpuCanvas> canvas; ///< null: the processor paints
    std::string painter; ///< what paints, for the statistics
    std::string complaint; ///< why the graphics card does not paint though it should; empty where all is well
};

/// Chooses what paints. Needs an OpenGL 3.3 context to be current. Never fails: where the card cannot, the processor
/// paints. `make` makes the canvas.
CanvasChoice choose_canvas(
    Painter wanted,
    std::function<std::unique_ptr<GpuCanvas>()> const& make = [] { return std::make_unique<GpuCanvas>(); });

/// The choice of the processor, since the graphics card cannot paint for this reason.
CanvasChoice processor_paints(std::string const& reason);

} // namespace framelet
