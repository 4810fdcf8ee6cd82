// What time a stretch of GL work took, by a clock that was checked before it is believed.
#pragma once

#include <gl/objects.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace postfx::gl {

/// Does this context's timer query see draws? Draws something known to be heavy and compares a TIME_ELAPSED
/// query with wall time around glFinish: llvmpipe reads nearly nothing. Takes about 0.1 s; ask once per
/// context, and only when times are wanted. Leaves framebuffer 0, program 0 and vertex array 0 bound.
struct ClockCheck {
    bool timer_queries_honest = false;
    double wall_ms = 0;    ///< of the heavy draw
    double queried_ms = 0; ///< what the query said
    std::string text; ///< "GL timestamps", or why not: "GL timer queries read 0.04 ms for a draw of 21 ms"
};
ClockCheck check_clock();

/// Process CPU time of all threads (CLOCK_PROCESS_CPUTIME_ID) and monotonic wall time, milliseconds.
struct HostTime {
    double cpu_ms = 0, wall_ms = 0;
    static HostTime now();
};

/// Timestamps around `spans` consecutive stretches per frame, read some frames late without waiting. All
/// queries are made at construction.
class TimestampRing {
public:
    explicit TimestampRing(std::size_t spans);
    /// Call spans()+1 marks per frame, in order: start of span 0, end of 0 = start of 1, ...
    void begin_frame();
    void mark();
    void end_frame();
    /// Milliseconds of each span of the newest finished frame; empty until there is one. Does not wait.
    const std::vector<double>& latest();

    std::size_t spans() const { return spans_; }

private:
    static constexpr std::size_t depth = 4; ///< frames in flight
    std::size_t spans_;
    std::vector<Query> queries_; ///< depth * (spans + 1)
    std::vector<double> latest_;
    std::size_t frame_ = 0, mark_ = 0, read_ = 0;
};

} // namespace postfx::gl
