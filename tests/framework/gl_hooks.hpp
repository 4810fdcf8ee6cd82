// Standing between the code and OpenGL: counting calls, or swallowing them. Works on glad's function pointers.
#pragma once

#include <postfx_glad/gl.h>

#include <tuple>

namespace postfx::testing {

/// While it lives, calls through one of the loader's pointers are counted, and forwarded unless `swallow`.
template<class Pointer, Pointer* slot>
class GlHook;

template<class Result, class... Arguments, Result (**slot)(Arguments...)>
class GlHook<Result (*)(Arguments...), slot> {
public:
    explicit GlHook(bool swallow = false) {
        real_ = *slot;
        calls_ = 0;
        *slot = swallow ? nothing : counted;
    }
    ~GlHook() { *slot = real_; }
    GlHook(const GlHook&) = delete;
    GlHook& operator=(const GlHook&) = delete;

    static int calls() { return calls_; }

private:
    static Result counted(Arguments... arguments) {
        ++calls_;
        return real_(arguments...);
    }
    static Result nothing(Arguments...) {
        ++calls_;
        return Result();
    }

    static inline Result (*real_)(Arguments...) = nullptr;
    static inline int calls_ = 0;
};

#define POSTFX_GL_HOOK(function)                                                                             \
    ::postfx::testing::GlHook<decltype(postfx_glad_##function), &postfx_glad_##function>

/// Hooks on several functions at once.
template<class... Hooks>
class GlHooks {
public:
    static int calls() { return (0 + ... + Hooks::calls()); }

private:
    template<class Hook>
    struct Counting : Hook {
        Counting() : Hook(false) {}
    };
    std::tuple<Counting<Hooks>...> hooks_;
};

/// Everything that makes an object or storage.
using GlCreations = GlHooks<
    POSTFX_GL_HOOK(glCreateTextures), POSTFX_GL_HOOK(glGenTextures), POSTFX_GL_HOOK(glTextureStorage2D),
    POSTFX_GL_HOOK(glTextureView), POSTFX_GL_HOOK(glCreateBuffers), POSTFX_GL_HOOK(glGenBuffers),
    POSTFX_GL_HOOK(glNamedBufferStorage), POSTFX_GL_HOOK(glNamedBufferData),
    POSTFX_GL_HOOK(glCreateFramebuffers), POSTFX_GL_HOOK(glGenFramebuffers),
    POSTFX_GL_HOOK(glCreateRenderbuffers), POSTFX_GL_HOOK(glGenRenderbuffers),
    POSTFX_GL_HOOK(glCreateVertexArrays), POSTFX_GL_HOOK(glGenVertexArrays), POSTFX_GL_HOOK(glCreateSamplers),
    POSTFX_GL_HOOK(glGenSamplers), POSTFX_GL_HOOK(glCreateQueries), POSTFX_GL_HOOK(glGenQueries),
    POSTFX_GL_HOOK(glCreateProgram), POSTFX_GL_HOOK(glCreateShader), POSTFX_GL_HOOK(glFenceSync)>;

} // namespace postfx::testing
