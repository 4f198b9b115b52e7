#include "client/window/picture_texture.h"

#include <algorithm>

#include <epoxy/gl.h>

#include "common/error.h"

namespace framelet {

namespace {

constexpr char const* vertex_source = R"(#version 330 core
out vec2 place;
void main() {
    place = vec2((gl_VertexID << 1) & 2, gl_VertexID & 2);
    gl_Position = vec4(place.x * 2.0 - 1.0, 1.0 - place.y * 2.0, 0.0, 1.0);
})";

constexpr char const* fragment_source = R"(#version 330 core
in vec2 place;
out vec4 color;
uniform sampler2D picture;
void main() { color = vec4(texture(picture, place).rgb, 1.0); })";

GLuint compile(GLenum kind, char const* source) {
    GLuint const shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == 0) {
        throw InputError("the graphics driver refuses a shader of OpenGL 3.3: use framelet-client instead");
    }
    return shader;
}

} // namespace

PictureTexture::PictureTexture() {
    GLuint const vertex = compile(GL_VERTEX_SHADER, vertex_source);
    GLuint const fragment = compile(GL_FRAGMENT_SHADER, fragment_source);
    program_ = glCreateProgram();
    glAttachShader(program_, vertex);
    glAttachShader(program_, fragment);
    glLinkProgram(program_);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint good = 0;
    glGetProgramiv(program_, GL_LINK_STATUS, &good);
    if (good == 0) {
        throw InputError("the graphics driver refuses to link shaders of OpenGL 3.3: use framelet-client instead");
    }
    glGenVertexArrays(1, &vertices_);
    glGenTextures(1, &texture_);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
}

PictureTexture::~PictureTexture() {
    glDeleteTextures(1, &texture_);
    glDeleteVertexArrays(1, &vertices_);
    glDeleteProgram(program_);
}

void PictureTexture::upload(Picture const& picture, std::span<PixelRect const> changed) {
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, picture.width);
    bool const is_shown = shown_ == texture_; // else nobody has told what has changed in it
    if (picture.width != width_ || picture.height != height_ || !is_shown) {
        width_ = picture.width;
        height_ = picture.height;
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width_, height_, 0, GL_RGBA, GL_UNSIGNED_BYTE, picture.rgba.data());
    } else {
        for (std::size_t i = 0; i < changed.size();) {
            PixelRect rect = changed[i];
            for (++i; i < changed.size() && changed[i].top == rect.top && changed[i].bottom == rect.bottom; ++i) {
                rect.left = std::min(rect.left, changed[i].left);
                rect.right = std::max(rect.right, changed[i].right);
            }
            glTexSubImage2D(GL_TEXTURE_2D, 0, rect.left, rect.top, rect.width(), rect.height(), GL_RGBA,
                            GL_UNSIGNED_BYTE, picture.row(rect.top) + static_cast<std::size_t>(rect.left) * 4);
        }
    }
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    show(texture_, width_, height_);
}

void PictureTexture::show(std::uint32_t texture, int width, int height) {
    shown_ = texture;
    shown_width_ = width;
    shown_height_ = height;
}

void PictureTexture::draw(int width, int height) {
    glViewport(0, 0, width, height);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    if (shown_ == 0) {
        return;
    }
    glDisable(GL_BLEND);
    glUseProgram(program_);
    glBindVertexArray(vertices_);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, shown_);
    GLint const filter = width == shown_width_ && height == shown_height_ ? GL_NEAREST : GL_LINEAR;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
    glDrawArrays(GL_TRIANGLES, 0, 3); // one triangle that covers everything
}

} // namespace framelet
