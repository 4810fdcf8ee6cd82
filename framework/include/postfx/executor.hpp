// Draws plans. From here on there is OpenGL: a current 4.5 core context.
#pragma once

#include <postfx/image.hpp>
#include <postfx/plan.hpp>
#include <postfx/report.hpp>

#include <cstdint>
#include <filesystem>
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

class Executor {
public:
    /// `program_cache`: directory for linked programs between runs; empty = none.
    explicit Executor(std::filesystem::path program_cache = {});
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
    std::uint32_t run(const FrameInputs& inputs, Timing timing = Timing::off, Watch watch = Watch::off);

    /// What the last run did and cost.
    Report report() const;

    /// The picture of the last run (waits for it).
    Image read_picture() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace postfx
