// An OpenGL 3.3 context without a window, on whatever renderer there is: in tests Mesa's on the processor. In: nothing.
// Out: a current context, or none.
#pragma once

#include <epoxy/egl.h>
#include <epoxy/gl.h>

namespace framelet {

class GlContext {
public:
    GlContext() {
        if (!epoxy_has_egl()) {
            return;
        }
        display_ = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
        if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) == EGL_FALSE) {
            return;
        }
        eglBindAPI(EGL_OPENGL_API);
        constexpr EGLint wanted[]{EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
        constexpr EGLint version[]{
            EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        eglChooseConfig(display_, wanted, &config, 1, &count);
        context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
        is_there_ = context_ != EGL_NO_CONTEXT &&
                    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) != EGL_FALSE;
    }
    ~GlContext() {
        if (is_there_) {
            eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        }
        if (context_ != EGL_NO_CONTEXT) {
            eglDestroyContext(display_, context_);
        }
    }
    GlContext(GlContext const&) = delete;
    GlContext& operator=(GlContext const&) = delete;

    bool is_there() const { return is_there_; }

private:
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    bool is_there_ = false;
};

} // namespace framelet
