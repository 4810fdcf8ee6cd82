// Finds the first image with NaN or infinite values: counts them in every image right after it was drawn.
#pragma once

#include <gl/objects.hpp>
#include <report/run.hpp>

#include <postfx/plan.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace postfx {

/// Counts of one frame: of the plan's attachments first, then of every pass's outputs in order. [GL thread]
class NonfiniteWatch {
public:
    explicit NonfiniteWatch(const Plan& plan);

    /// Forget the frame before.
    void begin_frame();
    /// Count the next image's pixels that have a component which is no number.
    void count(GLuint texture, int width, int height);

    /// What was counted, in the order of drawing. Waits for the GPU.
    std::vector<NonfiniteCount> read() const;

private:
    gl::Program program_;
    gl::Buffer counts_; ///< per image: pixels, index of the first one
    std::size_t images_ = 0, next_ = 0;
};

} // namespace postfx
