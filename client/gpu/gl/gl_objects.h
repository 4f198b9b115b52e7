// Objects of OpenGL 3.3 that give back what they hold. In: sizes and formats. Out: names for OpenGL's functions. They
// use only what WebGL 2 has too, and need one context to be current in all calls, at destruction too.
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <utility>
#include <vector>

namespace framelet {

/// Counts the objects of OpenGL that are made, so that a test can see that none is once all are there.
struct GlCount {
    std::size_t made = 0;
};

/// The name of an object of OpenGL, which is deleted by the function of its kind.
class GlName {
public:
    enum class Kind : std::uint8_t { texture, framebuffer, buffer, vertex_array, program };

    GlName() = default;
    GlName(Kind kind, GlCount& count);
    ~GlName();
    GlName(GlName&& other) noexcept : kind_(other.kind_), name_(std::exchange(other.name_, 0)) {}
    GlName& operator=(GlName&& other) noexcept {
        std::swap(kind_, other.kind_);
        std::swap(name_, other.name_);
        return *this;
    }

    std::uint32_t get() const { return name_; }

private:
    Kind kind_ = Kind::texture;
    std::uint32_t name_ = 0; ///< 0: none
};

/// Texels in a row of a table, as tables.glsl has it.
inline constexpr int table_width = 1024;

enum class TexelFormat : std::uint8_t { color, depth, number, four_numbers, four_floats };

/// A texture of two dimensions whose texels are read one by one, and which can be rendered to.
class GlPlane {
public:
    GlPlane() = default;
    /// Throws CanvasError where the card has no room for it.
    GlPlane(TexelFormat format, int width, int height, GlCount& count);

    std::uint32_t texture() const { return name_.get(); }
    int width() const { return width_; }
    int height() const { return height_; }

private:
    GlName name_;
    int width_ = 0, height_ = 0;
};

/// A table of numbers that a shader reads, `words` in each texel (1 or 4), `table_width` texels a row.
class GlTable {
public:
    GlTable(TexelFormat format, std::size_t words, GlCount& count) : format_(format), words_(words), count_(&count) {}

    /// Replaces what the table has, and fills up `words` to whole rows; grows by doubling. Throws CanvasError where
    /// that is too much.
    void upload(std::vector<std::uint32_t>& words);
    std::uint32_t texture() const { return plane_.texture(); }

private:
    TexelFormat format_;
    std::size_t words_;
    GlCount* count_;
    GlPlane plane_;
};

/// A framebuffer of planes of one size.
class GlTarget {
public:
    GlTarget() = default;
    /// Throws CanvasError where the card cannot render to them.
    GlTarget(std::initializer_list<GlPlane const*> planes, GlCount& count);

    std::uint32_t get() const { return name_.get(); }
    int width() const { return width_; }
    int height() const { return height_; }

private:
    GlName name_;
    int width_ = 0, height_ = 0;
};

/// Copies a target's first plane to the framebuffer of the context, which has the same size, rows from the top.
void show_on_screen(GlTarget const& target);

/// Clears OpenGL's errors: what others have done wrong is not to be taken for ours.
void forget_errors();
/// Throws CanvasError where OpenGL says that memory is missing, or that a call was wrong.
void check_gl(char const* what);

} // namespace framelet
