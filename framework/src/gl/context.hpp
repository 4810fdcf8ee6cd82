// OpenGL 4.5 core without a display, through EGL.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace postfx::gl {

struct DeviceInfo {
    std::string vendor, renderer, version;
    std::string platform;  ///< "EGL surfaceless", "EGL device 0 (/dev/dri/card0)"; "" where current_device()
                           ///< can't know
    bool software = false; ///< llvmpipe, softpipe, SwiftShader, ...: timer queries don't see draws
};

/// What the current context is. Needs a current context and loaded functions.
DeviceInfo current_device();

/// How a window system finds a GL function: eglGetProcAddress, glfwGetProcAddress.
using FunctionLoader = void (*(*)(const char* name))();

/// Load the GL functions of the current context and check that it is 4.5; throws Error that says what was
/// found and what to install.
void load_functions(FunctionLoader loader);

/// The context that was current on the thread that made this, as EGL or GLX names it.
class CurrentContext {
public:
    /// Finds nothing where neither has a current context; then is_current() can't be told and is true.
    CurrentContext();

    bool found() const { return context_ != nullptr; }
    /// Is it current on the calling thread? [any thread]
    bool is_current() const { return !context_ || ask_() == context_; }
    /// How its window system finds a GL function; null when it was not found.
    FunctionLoader loader() const { return loader_; }

private:
    void* (*ask_)() = nullptr;
    FunctionLoader loader_ = nullptr;
    void* context_ = nullptr;
};

/// The current context, with its functions loaded if nobody has yet: by `get_proc_address`, or else as its window
/// system does. Throws Error when there is none or it is older than 4.5. [any thread]
CurrentContext require_context(const std::function<void*(const char* name)>& get_proc_address);

/// A context of its own, current on this thread from construction on. Tries EGL devices with a GPU first,
/// then Mesa surfaceless; POSTFX_GL=surfaceless|device forces one (`device` takes a software device too).
/// KHR_debug output is on when `debug`. Throws Error with one reason per platform that was tried.
class HeadlessContext {
public:
    explicit HeadlessContext(bool debug = false);
    /// Another one of the device that `like` describes, for another thread. GL's functions are loaded already: they
    /// are the process's, and other threads may be calling them. Throws Error where there is no such device.
    explicit HeadlessContext(const DeviceInfo& like);
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

    const DeviceInfo& device() const { return device_; }

private:
    struct State;
    std::unique_ptr<State> state_;
    DeviceInfo device_;
};

/// Collect KHR_debug messages above notification from now on, for the current context. Messages are kept per
/// thread (at most 1000) until taken.
void enable_debug_output();
std::vector<std::string> take_debug_messages();

/// A named group around commands, for RenderDoc, apitrace and the debug output. Does nothing before GL is
/// loaded.
class DebugGroup {
public:
    explicit DebugGroup(const char* name);
    ~DebugGroup();
    DebugGroup(const DebugGroup&) = delete;
    DebugGroup& operator=(const DebugGroup&) = delete;
};

} // namespace postfx::gl
