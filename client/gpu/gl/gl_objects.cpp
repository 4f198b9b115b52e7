#include "client/gpu/gl/gl_objects.h"

#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include <epoxy/gl.h>

#include "common/picture/block_canvas.h"

namespace framelet {

namespace {

struct GlFormat {
    GLint internal;
    GLenum format, type;
};

GlFormat format_of(TexelFormat format) {
    switch (format) {
    case TexelFormat::color:
        return {GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE};
    case TexelFormat::depth:
        return {GL_R32F, GL_RED, GL_FLOAT};
    case TexelFormat::number:
        return {GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT};
    case TexelFormat::four_numbers:
        return {GL_RGBA32UI, GL_RGBA_INTEGER, GL_UNSIGNED_INT};
    case TexelFormat::four_floats:
        break;
    }
    return {GL_RGBA32F, GL_RGBA, GL_FLOAT};
}

} // namespace

GlName::GlName(Kind kind, GlCount& count) : kind_(kind) {
    switch (kind) {
    case Kind::texture:
        glGenTextures(1, &name_);
        break;
    case Kind::framebuffer:
        glGenFramebuffers(1, &name_);
        break;
    case Kind::buffer:
        glGenBuffers(1, &name_);
        break;
    case Kind::vertex_array:
        glGenVertexArrays(1, &name_);
        break;
    case Kind::program:
        name_ = glCreateProgram();
        break;
    }
    ++count.made;
}

GlName::~GlName() {
    if (name_ == 0) {
        return;
    }
    switch (kind_) {
    case Kind::texture:
        glDeleteTextures(1, &name_);
        break;
    case Kind::framebuffer:
        glDeleteFramebuffers(1, &name_);
        break;
    case Kind::buffer:
        glDeleteBuffers(1, &name_);
        break;
    case Kind::vertex_array:
        glDeleteVertexArrays(1, &name_);
        break;
    case Kind::program:
        glDeleteProgram(name_);
        break;
    }
}

GlPlane::GlPlane(TexelFormat format, int width, int height, GlCount& count)
    : name_(GlName::Kind::texture, count), width_(width), height_(height) {
    auto const [internal, external, type] = format_of(format);
    glBindTexture(GL_TEXTURE_2D, name_.get());
    glTexImage2D(GL_TEXTURE_2D, 0, internal, width, height, 0, external, type, nullptr);
    for (GLenum const filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
        glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
    }
    for (GLenum const wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T}) {
        glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    check_gl("a texture");
}

void GlTable::upload(std::vector<std::uint32_t>& words) {
    std::size_t const row = std::size_t{table_width} * words_;
    std::size_t const rows = (words.size() + row - 1) / row;
    if (rows == 0 && plane_.texture() != 0) {
        return;
    }
    if (plane_.texture() == 0 || rows > static_cast<std::size_t>(plane_.height())) {
        GLint most = 0;
        glGetIntegerv(GL_MAX_TEXTURE_SIZE, &most);
        std::size_t const height =
            std::min(std::bit_ceil(std::max(rows, std::size_t{1})), static_cast<std::size_t>(most));
        if (height < rows) {
            throw CanvasError("more is to be painted than a texture of the graphics card can have");
        }
        plane_ = GlPlane(format_, table_width, static_cast<int>(height), *count_);
    }
    words.resize(rows * row); // whole rows
    auto const [internal, external, type] = format_of(format_);
    glBindTexture(GL_TEXTURE_2D, plane_.texture());
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, table_width, static_cast<GLsizei>(rows), external, type, words.data());
}

GlTarget::GlTarget(std::initializer_list<GlPlane const*> planes, GlCount& count)
    : name_(GlName::Kind::framebuffer, count), width_((*planes.begin())->width()),
      height_((*planes.begin())->height()) {
    glBindFramebuffer(GL_FRAMEBUFFER, name_.get());
    std::array<GLenum, 4> buffers{};
    GLsizei number = 0;
    for (GlPlane const* const plane : planes) {
        GLenum const attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(number);
        glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, plane->texture(), 0);
        buffers[static_cast<std::size_t>(number++)] = attachment;
    }
    glDrawBuffers(number, buffers.data());
    bool const is_complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (!is_complete) {
        throw CanvasError("the graphics card cannot render to textures of numbers");
    }
}

void show_on_screen(GlTarget const& target) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.get());
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    int const width = target.width();
    int const height = target.height();
    glBlitFramebuffer(0, 0, width, height, 0, height, width, 0, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void forget_errors() {
    constexpr int most = 16; // a context that is lost says so for ever
    for (int i = 0; i < most && glGetError() != GL_NO_ERROR; ++i) {
    }
}

void check_gl(char const* what) {
    GLenum const error = glGetError();
    if (error == GL_OUT_OF_MEMORY) {
        throw CanvasError(std::string("the graphics card has no memory for ") + what);
    }
    if (error != GL_NO_ERROR) {
        throw CanvasError("OpenGL refuses " + std::string(what) + " (error " + std::to_string(error) + ")");
    }
}

} // namespace framelet
