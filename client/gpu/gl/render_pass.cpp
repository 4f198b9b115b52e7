#include "client/gpu/gl/render_pass.h"

#include <array>
#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "common/picture/block_canvas.h"

namespace framelet {

namespace {

#ifdef __EMSCRIPTEN__
constexpr char const* version = "#version 300 es\n"
                                "precision highp float; precision highp int; precision highp sampler2D;\n"
                                "precision highp usampler2D; precision highp usampler2DArray;\n";
#else
constexpr char const* version = "#version 330 core\n";
#endif

void attach(GLuint program, GLenum kind, std::initializer_list<char const*> texts) {
    std::vector<char const*> all{version};
    all.insert(all.end(), texts.begin(), texts.end());
    GLuint const shader = glCreateShader(kind);
    glShaderSource(shader, static_cast<GLsizei>(all.size()), all.data(), nullptr);
    glCompileShader(shader);
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == 0) {
        std::array<char, 512> log{};
        glGetShaderInfoLog(shader, log.size() - 1, nullptr, log.data());
        glDeleteShader(shader);
        std::string line(log.data());
        throw CanvasError("the graphics driver refuses a shader: " + line.substr(0, line.find('\n')));
    }
    glAttachShader(program, shader);
    glDeleteShader(shader); // with the program
}

} // namespace

RenderPass::RenderPass(std::initializer_list<char const*> vertex, std::initializer_list<char const*> fragment,
                       std::initializer_list<char const*> textures, GlCount& count)
    : program_(GlName::Kind::program, count) {
    GLuint const program = program_.get();
    attach(program, GL_VERTEX_SHADER, vertex);
    attach(program, GL_FRAGMENT_SHADER, fragment);
    glLinkProgram(program);
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good == 0) {
        throw CanvasError("the graphics driver refuses to link shaders");
    }
    glUseProgram(program);
    GLint unit = 0;
    for (char const* const name : textures) {
        glUniform1i(glGetUniformLocation(program, name), unit++);
    }
    glUseProgram(0);
}

void RenderPass::begin(GlTarget const& target, std::initializer_list<std::uint32_t> textures, bool of_layers) const {
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    glViewport(0, 0, target.width(), target.height());
    glUseProgram(program_.get());
    GLenum unit = GL_TEXTURE0;
    for (std::uint32_t const texture : textures) {
        glActiveTexture(unit);
        glBindTexture(of_layers && unit == GL_TEXTURE0 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D, texture);
        ++unit;
    }
    glActiveTexture(GL_TEXTURE0);
}

void RenderPass::set(char const* name, float value) const {
    glUniform1f(glGetUniformLocation(program_.get(), name), value);
}

void RenderPass::set(char const* name, int value) const {
    glUniform1i(glGetUniformLocation(program_.get(), name), value);
}

void RenderPass::set(char const* name, int x, int y) const {
    glUniform2i(glGetUniformLocation(program_.get(), name), x, y);
}

void RenderPass::set(char const* name, float x, float y) const {
    glUniform2f(glGetUniformLocation(program_.get(), name), x, y);
}

void RenderPass::draw_all() const {
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace framelet
