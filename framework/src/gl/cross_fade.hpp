// A picture that turns into that of other levels without a visible step; only one frame is drawn at both. [GL thread]
#pragma once

#include <gl/objects.hpp>

#include <cstdint>

namespace postfx::gl {

/// Adds to pictures what that of the old levels had beyond that of the new ones, less of it in every frame. Both are of
/// the same frame, so that what moves leaves no trail but of that difference. While nothing moves, frames are even steps
/// from one to the other.
class CrossFade {
public:
    CrossFade();
    /// From this picture of display codes (rgba8) to the one of the same frame that show() is given next, in so many
    /// steps. At 1 nothing is done.
    void begin(std::uint32_t shown, int width, int height, int steps);
    /// What to show of the picture that was drawn: it itself when no change is under way, else a texture that the next
    /// call overwrites.
    std::uint32_t show(std::uint32_t drawn, int width, int height);

private:
    /// Made when it has another size than is needed.
    struct Target {
        Texture texture;
        Framebuffer framebuffer;
        void fit(int width, int height, Format format);
    };
    void add(const Target& target, std::uint32_t a, double weight_of_a, std::uint32_t b,
             double weight_of_b) const;

    Program program_;
    VertexArray vertex_array_;
    Target before_, surplus_, shown_;
    int steps_ = 1, done_ = 1; ///< of the change under way; none when all are done
};

} // namespace postfx::gl
