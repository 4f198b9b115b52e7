// A program that renders from textures into textures. In: the text of two shaders, names of what they read. Out: draws.
#pragma once

#include <cstdint>
#include <initializer_list>

#include "client/gpu/gl/gl_objects.h"

namespace framelet {

class RenderPass {
public:
    /// `textures`: the names of the samplers, in the order in which `begin` is given theirs. Each text is of functions
    /// and declarations; the version is put before them. Throws CanvasError where the driver refuses them.
    RenderPass(std::initializer_list<char const*> vertex, std::initializer_list<char const*> fragment,
               std::initializer_list<char const*> textures, GlCount& count);

    /// Begins to draw with this program into the target. `textures` are those that its samplers read, in order;
    /// `of_layers`: the first of them is an array of textures.
    void begin(GlTarget const& target, std::initializer_list<std::uint32_t> textures, bool of_layers = false) const;
    void set(char const* name, float value) const;
    void set(char const* name, int value) const;
    void set(char const* name, int x, int y) const;
    void set(char const* name, float x, float y) const;
    /// Draws every pixel of the target.
    void draw_all() const;

private:
    GlName program_;
};

} // namespace framelet
