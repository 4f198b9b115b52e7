#include "client/gpu/canvas_choice.h"

#include <gtest/gtest.h>

#include "client/gpu/gl/render_pass.h"
#include "common/error.h"
#include "tests/gpu/gl_context.h"

namespace framelet {
namespace {

TEST(CanvasChoice, KnowsItsNames) {
    EXPECT_EQ(parse_painter("auto"), Painter::automatic);
    EXPECT_EQ(parse_painter("cpu"), Painter::cpu);
    EXPECT_EQ(parse_painter("gpu"), Painter::gpu);
    for (char const* const wrong : {"", "GPU", "card"}) {
        EXPECT_THROW(parse_painter(wrong), InputError) << wrong;
    }
}

TEST(CanvasChoice, KnowsRenderersThatAreNoCards) {
    for (char const* const name : {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "", "Software Rasterizer",
                                   "Google SwiftShader", "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device))"}) {
        EXPECT_TRUE(is_software(name)) << name;
    }
    for (char const* const name : {"Mesa Intel(R) Xe Graphics (TGL GT2)", "AMD Radeon Graphics (radeonsi, renoir)",
                                   "NVIDIA GeForce RTX 3060/PCIe/SSE2", "Apple M1", "V3D 4.2", "virgl"}) {
        EXPECT_FALSE(is_software(name)) << name;
    }
}

TEST(CanvasChoice, TakesTheCardWhereItIsToOrWhereThereIsOne) {
    GlContext const context;
    if (!context.is_there()) {
        GTEST_SKIP() << "there is no OpenGL 3.3";
    }
    CanvasChoice const processor = choose_canvas(Painter::cpu);
    EXPECT_EQ(processor.canvas, nullptr);
    EXPECT_EQ(processor.painter, "processor");
    EXPECT_EQ(processor.complaint, "");
    CanvasChoice const card = choose_canvas(Painter::gpu);
    EXPECT_NE(card.canvas, nullptr);
    EXPECT_EQ(card.painter.rfind("OpenGL, ", 0), 0u) << card.painter;
    EXPECT_EQ(card.complaint, "");
    bool const is_on_processor = is_software(card.painter);
    CanvasChoice const chosen = choose_canvas(Painter::automatic);
    EXPECT_EQ(chosen.canvas == nullptr, is_on_processor) << card.painter;
    EXPECT_EQ(chosen.complaint, "");
}

TEST(CanvasChoice, TheProcessorPaintsWhereTheCardCannot) {
    GlContext const context;
    if (!context.is_there()) {
        GTEST_SKIP() << "there is no OpenGL 3.3";
    }
    CanvasChoice const choice =
        choose_canvas(Painter::gpu, []() -> std::unique_ptr<GpuCanvas> { throw CanvasError("it is too old"); });
    EXPECT_EQ(choice.canvas, nullptr);
    EXPECT_EQ(choice.painter, "processor");
    EXPECT_EQ(choice.complaint, "the processor paints, since it is too old");
}

TEST(CanvasChoice, AShaderThatIsRefusedIsToldOfInOneLine) {
    GlContext const context;
    if (!context.is_there()) {
        GTEST_SKIP() << "there is no OpenGL 3.3";
    }
    GlCount count;
    try {
        RenderPass const pass({"void main() { gl_Position = vec4(0.0); }"}, {"void main() {\nno;\nnor this;\n}"}, {},
                              count);
        FAIL() << "that is no shader";
    } catch (CanvasError const& error) {
        std::string const line = error.what();
        EXPECT_EQ(line.rfind("the graphics driver refuses a shader: ", 0), 0u) << line;
        EXPECT_EQ(line.find('\n'), std::string::npos) << line;
    }
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

} // namespace
} // namespace framelet
