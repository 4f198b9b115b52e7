#include "client/gpu/canvas_choice.h"

#include <algorithm>
#include <array>
#include <exception>

#include <epoxy/gl.h>

namespace framelet {

namespace {

constexpr char const* on_processor = "processor";

std::string renderer_name() {
    auto const* const name = reinterpret_cast<char const*>(glGetString(GL_RENDERER));
    return name == nullptr ? "" : name;
}

} // namespace

bool is_software(std::string_view renderer) {
    constexpr std::array<std::string_view, 5> names{"llvmpipe", "softpipe", "SwiftShader", "Software Rasterizer",
                                                    "GDI Generic"};
    return renderer.empty() || std::ranges::any_of(names, [renderer](std::string_view name) {
               return renderer.find(name) != std::string_view::npos;
           });
}

CanvasChoice choose_canvas(Painter wanted, std::function<std::unique_ptr<GpuCanvas>()> const& make) {
    std::string const renderer = renderer_name();
    if (wanted == Painter::cpu || (wanted == Painter::automatic && is_software(renderer))) {
        return {nullptr, on_processor, ""};
    }
    try {
        return {make(), "OpenGL, " + renderer, ""};
    } catch (std::exception const& error) {
        return processor_paints(error.what());
    }
}

CanvasChoice processor_paints(std::string const& reason) {
    return {nullptr, on_processor, "the processor paints, since " + reason};
}

} // namespace framelet
