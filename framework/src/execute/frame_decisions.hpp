// What the frame decides, without the CPU ever waiting for it: censuses of images, decisions by them, and the draw
// commands of the passes that depend on those.
#pragma once

#include <gl/objects.hpp>
#include <report/run.hpp>

#include <postfx/plan.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace postfx {

/// The GPU's side of one plan's decisions; layouts as in shaders/postfx/decide.glsl. [GL thread]
class FrameDecisions {
public:
    explicit FrameDecisions(const Plan& plan);

    /// Forget the frame before; bind the buffers.
    void begin_frame() const;
    /// Where in the bound indirect buffers the pass's command is; nothing if it is unconditional.
    std::optional<GLintptr> command(std::size_t pass_index) const;
    /// Draw, count or decide with the current program and textures; nothing happens where a condition fails.
    void execute(const Pass& pass, std::size_t pass_index) const;

    /// Of the last frame. Waits for the GPU.
    FrameOutcome read() const;

private:
    std::vector<std::byte> fresh_censuses_, fresh_decisions_;
    std::vector<int> command_of_pass_; ///< -1: unconditional
    gl::Buffer censuses_, decisions_, conditionals_, terms_, commands_;
};

} // namespace postfx
