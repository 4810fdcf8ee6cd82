// Draws plans. From here on there is OpenGL: a context of 4.5 or later, the host's own, made by whatever window system.
//
// Threads: an Executor belongs to the context that is current when it is made. Everything of it is
// [thread of the context]: called where that context is current, on whatever thread that is, by one thread at a time.
// Several executors, of one context or of several, do not know of each other.
// Units: sizes in pixels, rows from the bottom as OpenGL counts, times in the unit that their name ends with.
// Errors: everything here throws postfx::Error and leaves the executor as it was before the call.
#pragma once

#include <postfx/image.hpp>
#include <postfx/plan.hpp>
#include <postfx/report.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <vector>

namespace postfx {

/// What changes from frame to frame without a new plan.
struct FrameInputs {
    std::vector<std::uint32_t> textures; ///< GL names, in the order of Plan::attachments
    Camera camera; ///< where it is now; same projection as in the plan's facts, whose scene bounds still hold
    double time = 0;         ///< seconds
    std::uint32_t frame = 0; ///< counts frames; noise is a function of (pixel, frame, seed)
    std::uint32_t seed = 0;
};

/// Where in a framebuffer of the host's the picture goes.
struct OutputTarget {
    std::uint32_t framebuffer = 0; ///< its GL name; 0 = the window's
    int x = 0, y = 0;              ///< pixels: of the rectangle's lower left corner
    int width = 0,
        height = 0; ///< pixels, 1 or more; a picture of another size is stretched, filtered linearly
};

enum class Timing {
    off,
    gpu,     ///< GL timestamps, read some frames late
    profile, ///< CPU time of all threads and wall time, with glFinish around every pass: honest on software
             ///< GL
};

enum class Watch {
    off,
    nonfinite, ///< count NaN and infinite pixels of every input and after every pass: one more read of each image
};

struct ExecutorOptions {
    /// Directory for linked programs between runs; empty = none.
    std::filesystem::path program_cache{};
    /// How the host's window system finds a GL function: SDL_GL_GetProcAddress, or a lambda that casts what
    /// glfwGetProcAddress gives. Without it EGL and GLX are asked, whichever has a current context. What was found
    /// first serves all executors of the process.
    std::function<void*(const char* name)> get_proc_address{};
    /// Does every call leave the context's state as it found it? It takes some hundred glGet a frame: 8 to 25
    /// microseconds of CPU on llvmpipe (gl_state_gl_test measures it); where a driver runs on a thread of its own, they
    /// wait for it.
    ///
    /// Without, run() and compile() leave: program, draw framebuffer and samplers 0 to 15 unbound (0); another vertex
    /// array, 2D textures of units 0 to 15, buffer texture of unit 16, uniform buffers 0 and 1, storage
    /// buffers 0 to 7, indirect buffers; viewport 0; polygons filled, color masks on, clip control as OpenGL begins with,
    /// and off: blending, depth, stencil and scissor test (of viewport 0), culling, sRGB framebuffers, dither, logic
    /// operation, rasterizer discard, polygon smoothing, all of multisampling but itself, primitive restart and clip
    /// distances.
    ///
    /// Either way: queries of the host that run count our draws too. Between glBeginConditionalRender and
    /// glEndConditionalRender the host must not call run(), whose draws OpenGL would drop without a word. prepare() may
    /// take an error that glGetError() has not told yet. A program that is in use and already deleted is gone.
    bool keep_gl_state = true;
};

class Executor {
public:
    /// Of the current context. Throws Error when there is none or it is older than 4.5.
    explicit Executor(std::filesystem::path program_cache = {});
    explicit Executor(ExecutorOptions options);
    /// Where its context is not current any more, the GL objects are left to end with that context.
    ~Executor();
    Executor(Executor&&) noexcept;
    Executor& operator=(Executor&&) noexcept;

    /// Compile and allocate what `plan` needs and make it current. If a shader fails, throws Error with
    /// effect, file and line, and the plan before stays current.
    ///
    /// `formats`: of the attachments, in the order of Plan::attachments. With them, programs that no cache holds are
    /// compiled on a second thread too, up to the first run, where that helps: a software renderer, more than one
    /// core, and a driver whose cache hands on what was compiled. The picture is the same.
    void prepare(const Plan& plan, const std::vector<Format>& formats = {});

    /// Have the driver compile the current plan's programs to the end, which many put off until the first draw: passes
    /// are drawn as in run(), with rasterization off. `textures`: as in FrameInputs. Makes no picture.
    void compile(const std::vector<std::uint32_t>& textures);

    /// Draw the current plan. Creates no GL object and allocates no heap memory once it has run twice after
    /// prepare(). Returns the GL name of the picture's texture: the executor's own, valid until the next
    /// call, or an input.
    ///
    /// Throws Error, and draws nothing, before any prepare(); for a texture that is none, or not 2D, of another size than
    /// the plan's, of integers, multisampled, or the executor's own; for numbers of the camera or the time that are none;
    /// and where another context is current.
    std::uint32_t run(const FrameInputs& inputs, Timing timing = Timing::off, Watch watch = Watch::off);

    /// The same, into the host's framebuffer: what it holds outside of the rectangle stays. With Output::display those
    /// are sRGB codes, written as they are (also where the framebuffer calls itself sRGB); with Output::linear the
    /// chain's numbers. Throws Error for a framebuffer that can't be drawn to.
    void run(const FrameInputs& inputs, const OutputTarget& output, Timing timing = Timing::off,
             Watch watch = Watch::off);

    /// What the last run did and cost.
    Report report() const;

    /// The picture of the last run (waits for it).
    Image read_picture() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace postfx
