// Where programs that count their texture reads (plan/taps.hpp) add them up, pass by pass.
#pragma once

#include <gl/objects.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace postfx {

/// The sums of one plan. [GL thread]
class TapCounts {
public:
    /// At least one pass.
    explicit TapCounts(std::size_t passes);

    /// Forget the frame before.
    void begin_frame() const;
    /// The next draw or dispatch is of this pass.
    void bind(std::size_t pass_index) const;

    /// Per pass, of the last frame. Waits for the GPU.
    std::vector<std::uint64_t> read() const;

private:
    std::size_t passes_;
    gl::Buffer sums_;
};

} // namespace postfx
