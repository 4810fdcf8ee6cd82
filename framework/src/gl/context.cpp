#include <gl/context.hpp>

#include <postfx/error.hpp>

#include <postfx_glad/gl.h>

#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <dlfcn.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <mutex>
#include <string_view>

namespace postfx::gl {
namespace {

constexpr std::string_view what_to_install =
    "postfx needs OpenGL 4.5; install a graphics driver, or Mesa's software renderer "
    "(Debian: apt-get install libgl1-mesa-dri libegl-mesa0)";

std::string gl_string(GLenum name) {
    const GLubyte* text = postfx_glad_glGetString ? glGetString(name) : nullptr;
    return text ? reinterpret_cast<const char*>(text) : "unknown";
}

bool is_software(std::string renderer) {
    std::transform(renderer.begin(), renderer.end(), renderer.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    constexpr std::array<std::string_view, 6> names = {"llvmpipe", "softpipe", "swiftshader",
                                                       "swrast",   "software", "basic render"};
    return std::any_of(names.begin(), names.end(),
                       [&](std::string_view name) { return renderer.find(name) != std::string::npos; });
}

bool has_word(const char* words, std::string_view word) {
    const std::string padded = fmt::format(" {} ", words ? words : "");
    return padded.find(fmt::format(" {} ", word)) != std::string::npos;
}

template<class Function>
Function egl_function(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

/// A place where a context can perhaps be made.
struct Platform {
    std::string name;
    EGLenum kind = 0;
    void* native = EGL_DEFAULT_DISPLAY;
    bool want_gpu = false; ///< refuse a software renderer here
};

std::vector<Platform> egl_devices(bool with_software) {
    const auto query_devices = egl_function<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto query_string = egl_function<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    std::array<EGLDeviceEXT, 32> devices{};
    EGLint count = 0;
    if (!query_devices || !query_string
        || !query_devices(static_cast<EGLint>(devices.size()), devices.data(), &count)) {
        return {};
    }
    std::vector<Platform> found;
    for (EGLint i = 0; i < count; ++i) {
        EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
        const char* extensions = query_string(device, EGL_EXTENSIONS);
        if (!with_software && has_word(extensions, "EGL_MESA_device_software")) continue;
        // Asking for a string whose extension is absent would be an EGL error.
        const char* file = has_word(extensions, "EGL_EXT_device_drm")
                               ? query_string(device, EGL_DRM_DEVICE_FILE_EXT)
                               : nullptr;
        found.push_back({file ? fmt::format("EGL device {} ({})", i, file) : fmt::format("EGL device {}", i),
                         EGL_PLATFORM_DEVICE_EXT, device, !with_software});
    }
    return found;
}

/// In the order of trying.
std::vector<Platform> platforms() {
    const char* variable = std::getenv("POSTFX_GL");
    const std::string_view forced = variable ? variable : "";
    if (!forced.empty() && forced != "device" && forced != "surfaceless") {
        throw Error(
            fmt::format("POSTFX_GL is \"{}\"; expected \"surfaceless\", \"device\" or nothing", forced));
    }
    std::vector<Platform> found;
    if (forced != "surfaceless") found = egl_devices(forced == "device");
    if (forced != "device") found.push_back({"EGL surfaceless", EGL_PLATFORM_SURFACELESS_MESA});
    return found;
}

std::string egl_failure(const char* call) {
    return fmt::format("{} failed with EGL error 0x{:x}", call, eglGetError());
}

EGLContext create_context(EGLDisplay display, EGLConfig config, bool debug) {
    const std::array<EGLint, 9> attributes = {EGL_CONTEXT_MAJOR_VERSION,
                                              4,
                                              EGL_CONTEXT_MINOR_VERSION,
                                              5,
                                              EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                              EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                              EGL_CONTEXT_OPENGL_DEBUG,
                                              debug ? EGL_TRUE : EGL_FALSE,
                                              EGL_NONE};
    EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
    // Without 4.5 take what there is, so that load_functions() can say what was found.
    return context != EGL_NO_CONTEXT ? context : eglCreateContext(display, config, EGL_NO_CONTEXT, nullptr);
}

std::string found_instead() {
    const DeviceInfo found = current_device();
    return fmt::format("found OpenGL \"{}\" by \"{}\" on \"{}\"", found.version, found.vendor,
                       found.renderer);
}

/// The functions are the process's: window systems give the same ones for every context.
std::mutex loading;
bool functions_are_loaded = false;

/// Load the current context's functions: "" if it is 4.5, else what was found.
std::string load_failure(FunctionLoader loader) {
    const std::lock_guard lock(loading);
    if (!postfx_glad_loadGL(loader) || !POSTFX_GLAD_GL_VERSION_4_5) return found_instead();
    functions_are_loaded = true;
    return "";
}

/// A function of a library that the program has loaded already, for itself only or for all; null if it has not.
void* loaded_symbol(const char* library, const char* name) {
    void* handle = dlopen(library, RTLD_LAZY | RTLD_NOLOAD);
    if (!handle) return nullptr;
    void* symbol = dlsym(handle, name);
    dlclose(handle); // one count less: the program's own keeps it loaded
    return symbol;
}

void* glx_symbol(const char* name) {
    for (const char* library : {"libGLX.so.0", "libGL.so.1"}) {
        if (void* symbol = loaded_symbol(library, name)) return symbol;
    }
    return nullptr;
}

GLADapiproc call_get_proc_address(void* get_proc_address, const char* name) {
    const auto& function = *static_cast<const std::function<void*(const char*)>*>(get_proc_address);
    return reinterpret_cast<GLADapiproc>(function(name));
}

bool is_at_least_4_5() {
    GLint major = 0, minor = 0;
    glGetIntegerv(GL_MAJOR_VERSION, &major);
    glGetIntegerv(GL_MINOR_VERSION, &minor);
    return major > 4 || (major == 4 && minor >= 5);
}

} // namespace

CurrentContext::CurrentContext() : ask_(eglGetCurrentContext), loader_(eglGetProcAddress) {
    context_ = ask_();
    if (context_) return;
    ask_ = reinterpret_cast<void* (*)()>(glx_symbol("glXGetCurrentContext"));
    loader_ = reinterpret_cast<FunctionLoader>(glx_symbol("glXGetProcAddressARB"));
    context_ = ask_ ? ask_() : nullptr;
}

CurrentContext require_context(const std::function<void*(const char* name)>& get_proc_address) {
    const CurrentContext context;
    if (!context.found() && !get_proc_address) {
        throw Error(
            "no OpenGL context is current on this thread, neither by EGL nor by GLX; make one current, "
            "or give ExecutorOptions::get_proc_address where another window system has made it");
    }
    const std::lock_guard lock(loading);
    if (!functions_are_loaded) {
        // Not const: the loader's interface is C's.
        std::function<void*(const char*)> given = get_proc_address;
        const int version = given ? postfx_glad_loadGLUserPtr(call_get_proc_address, &given)
                                  : postfx_glad_loadGL(context.loader());
        functions_are_loaded = version != 0 && POSTFX_GLAD_GL_VERSION_4_5 != 0;
    }
    if (!functions_are_loaded || !is_at_least_4_5())
        throw Error(fmt::format("{}; {}", found_instead(), what_to_install));
    return context;
}

DeviceInfo current_device() {
    DeviceInfo info;
    info.vendor = gl_string(GL_VENDOR);
    info.renderer = gl_string(GL_RENDERER);
    info.version = gl_string(GL_VERSION);
    info.software = is_software(info.renderer);
    return info;
}

void load_functions(FunctionLoader loader) {
    const std::string failure = load_failure(loader);
    if (!failure.empty()) throw Error(fmt::format("{}; {}", failure, what_to_install));
}

/// Destroys the context; the display stays initialised, since EGL displays are shared by the whole process
/// and eglTerminate would take other contexts with it.
struct HeadlessContext::State {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;

    /// `load` GL's functions too?
    State(const Platform& platform, bool debug, bool load) {
        const auto get_display = egl_function<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
        if (!get_display) throw Error("EGL has no eglGetPlatformDisplayEXT");
        display = get_display(platform.kind, platform.native, nullptr);
        if (display == EGL_NO_DISPLAY) throw Error(egl_failure("eglGetPlatformDisplayEXT"));
        if (!eglInitialize(display, nullptr, nullptr)) throw Error(egl_failure("eglInitialize"));
        if (!eglBindAPI(EGL_OPENGL_API)) throw Error(egl_failure("eglBindAPI"));
        const std::array<EGLint, 5> wanted = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT,
                                              EGL_NONE};
        EGLConfig config = nullptr;
        EGLint count = 0;
        if (!eglChooseConfig(display, wanted.data(), &config, 1, &count) || count == 0) {
            throw Error(egl_failure("eglChooseConfig"));
        }
        context = create_context(display, config, debug);
        if (context == EGL_NO_CONTEXT) throw Error(egl_failure("eglCreateContext"));
        try {
            make_current();
            if (load) load_and_check(platform);
        } catch (...) {
            destroy();
            throw;
        }
    }
    ~State() { destroy(); }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

private:
    void make_current() const {
        if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
            throw Error(egl_failure("eglMakeCurrent"));
        }
    }
    static void load_and_check(const Platform& platform) {
        const std::string failure = load_failure(eglGetProcAddress);
        if (!failure.empty()) throw Error(failure);
        const DeviceInfo found = current_device();
        if (platform.want_gpu && found.software)
            throw Error(fmt::format("only software ({})", found.renderer));
    }
    void destroy() {
        if (eglGetCurrentContext() == context) {
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        }
        eglDestroyContext(display, context);
    }
};

HeadlessContext::HeadlessContext(bool debug) {
    std::string reasons;
    for (const Platform& platform : platforms()) {
        try {
            state_ = std::make_unique<State>(platform, debug, true);
            device_ = current_device();
            device_.platform = platform.name;
            if (debug) enable_debug_output();
            return;
        } catch (const Error& error) {
            reasons += fmt::format("{}: {}; ", platform.name, error.what());
        }
    }
    if (reasons.empty()) reasons = "EGL lists no device; ";
    throw Error(fmt::format("no OpenGL 4.5 without a display; {}{}", reasons, what_to_install));
}

HeadlessContext::HeadlessContext(const DeviceInfo& like) {
    for (const Platform& platform : platforms()) {
        try {
            state_ = std::make_unique<State>(platform, false, false);
        } catch (const Error&) {
            continue; // this platform has none; the next may
        }
        device_ = current_device();
        device_.platform = platform.name;
        if (device_.vendor == like.vendor && device_.renderer == like.renderer
            && device_.version == like.version) {
            return;
        }
        state_.reset();
    }
    throw Error(fmt::format("no other context of \"{}\" without a display", like.renderer));
}

HeadlessContext::~HeadlessContext() = default;

} // namespace postfx::gl
