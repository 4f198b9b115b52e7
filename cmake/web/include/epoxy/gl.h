// What WebGL 2 has of OpenGL 3.3, for files that take it from libepoxy.
#pragma once

#include <GLES3/gl3.h>
#include <webgl/webgl2.h>

#undef GL_RENDERER
#define GL_RENDERER 0x9246 // WEBGL_debug_renderer_info's, since WebGL's own says nothing
