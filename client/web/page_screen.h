// The canvas of a web page that has a WebGL 2 context, for pictures that are in memory. In: pictures. Out: the canvas.
#pragma once

#include "client/gpu/gl/gl_objects.h"
#include "common/image.h"

namespace framelet {

/// Needs one context to be current in all calls, at destruction too.
class PageScreen {
public:
    /// Replaces what the canvas shows, which has this size. Throws CanvasError where there is no room for it.
    void show(Picture const& picture);

private:
    GlCount count_;
    GlPlane plane_;
    GlTarget target_;
};

} // namespace framelet
