#include <gl/clock.hpp>
#include <gl/context.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <ctime>
#include <string_view>

namespace postfx::gl {
namespace {

constexpr double milliseconds_per_nanosecond = 1e-6;

constexpr std::string_view triangle = R"(#version 450 core
void main() {
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
)";

constexpr std::string_view heavy = R"(#version 450 core
layout(location = 0) uniform int u_iterations;
layout(location = 0) out float o_value;
void main() {
    float value = gl_FragCoord.x;
    for (int i = 0; i < u_iterations; ++i) value = fract(value * 1.618034 + gl_FragCoord.y);
    o_value = value;
}
)";

Query make_time_elapsed_query() {
    GLuint name = 0;
    glCreateQueries(GL_TIME_ELAPSED, 1, &name);
    return Query(name);
}

double result_ms(GLuint query) {
    GLuint64 nanoseconds = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &nanoseconds);
    return static_cast<double>(nanoseconds) * milliseconds_per_nanosecond;
}

struct Measured {
    double wall_ms = 0, queried_ms = 0;
};

Measured smaller(const Measured& a, const Measured& b) {
    return {std::min(a.wall_ms, b.wall_ms), std::min(a.queried_ms, b.queried_ms)};
}

/// A draw whose length can be chosen. llvmpipe's query keeps about the last tile of each thread: with 256
/// tiles of 64x64 that is far from the whole draw also where there are many threads.
class HeavyDraw {
public:
    HeavyDraw() {
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.name());
        glViewportIndexedf(0, 0, 0, size, size);
        glUseProgram(program_.name());
        glBindVertexArray(vertex_array_.name());
        measure(1); // compiles
    }
    ~HeavyDraw() {
        glBindVertexArray(0);
        glUseProgram(0);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
    }
    HeavyDraw(const HeavyDraw&) = delete;
    HeavyDraw& operator=(const HeavyDraw&) = delete;

    Measured measure(int iterations) const {
        glUniform1i(0, iterations);
        const double start = HostTime::now().wall_ms;
        glBeginQuery(GL_TIME_ELAPSED, query_.name());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glEndQuery(GL_TIME_ELAPSED);
        glFinish();
        return {HostTime::now().wall_ms - start, result_ms(query_.name())};
    }

    Measured smallest_of(int count, int iterations) const {
        Measured smallest = measure(iterations);
        for (int i = 1; i < count; ++i)
            smallest = smaller(smallest, measure(iterations));
        return smallest;
    }

private:
    static constexpr int size = 1024;
    Texture target_{size, size, Format::r8};
    Framebuffer framebuffer_ = make_framebuffer({target_.name()});
    Program program_ = make_program(triangle, heavy, "clock check");
    VertexArray vertex_array_ = make_vertex_array();
    Query query_ = make_time_elapsed_query();
};

double clock_ms(clockid_t clock) {
    timespec time{};
    clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) * 1e3
           + static_cast<double>(time.tv_nsec) * milliseconds_per_nanosecond;
}

} // namespace

ClockCheck check_clock() {
    ClockCheck check;
    GLint bits = 0;
    glGetQueryiv(GL_TIME_ELAPSED, GL_QUERY_COUNTER_BITS, &bits);
    if (bits == 0) {
        check.text = "this driver has no GL timer queries";
        return check;
    }
    // On a busy machine a worker that loses its core in its last tile makes a lying clock look honest for
    // once. So the draw is short beside a scheduler's time slice, and of many the smallest figures count:
    // waiting only ever adds. Ten busy processes on two cores deceive even that one time in ten, so a
    // renderer known to be software is never believed.
    constexpr double long_enough_ms = 3; // the way to the GPU and back takes about a tenth of it
    constexpr int most_iterations = 1 << 20;
    constexpr int most_repeats = 40;
    const HeavyDraw heavy_draw;
    int iterations = 16;
    Measured best = heavy_draw.smallest_of(3, iterations);
    while (best.wall_ms < long_enough_ms && iterations < most_iterations) {
        iterations *= 2;
        best = heavy_draw.smallest_of(3, iterations);
    }
    for (int repeat = 0; repeat < most_repeats && best.queried_ms > 0.25 * best.wall_ms; ++repeat) {
        best = smaller(best, heavy_draw.measure(iterations));
    }
    check.wall_ms = best.wall_ms;
    check.queried_ms = best.queried_ms;
    // Between a lying clock's hundredth and an honest one's "nearly all".
    const bool sees_draws = best.queried_ms > 0.5 * best.wall_ms && best.queried_ms < 1.5 * best.wall_ms;
    const DeviceInfo device = current_device();
    check.timer_queries_honest = sees_draws && !device.software;
    if (check.timer_queries_honest) {
        check.text = "GL timestamps";
    } else if (sees_draws) {
        check.text = fmt::format("GL timer queries of {} don't see draws", device.renderer);
    } else {
        check.text = fmt::format("GL timer queries read {:.2f} ms for a draw of {:.1f} ms", check.queried_ms,
                                 check.wall_ms);
    }
    return check;
}

HostTime HostTime::now() {
    return {clock_ms(CLOCK_PROCESS_CPUTIME_ID), clock_ms(CLOCK_MONOTONIC)};
}

TimestampRing::TimestampRing(std::size_t spans) : spans_(spans) {
    std::vector<GLuint> names(depth * (spans + 1));
    glCreateQueries(GL_TIMESTAMP, static_cast<GLsizei>(names.size()), names.data());
    for (GLuint name : names)
        queries_.emplace_back(name);
    latest_.reserve(spans);
}

void TimestampRing::begin_frame() {
    mark_ = 0;
    // A full ring gives up its oldest frame rather than wait for it.
    if (frame_ - read_ == depth) ++read_;
}

void TimestampRing::mark() {
    assert(mark_ <= spans_);
    glQueryCounter(queries_[frame_ % depth * (spans_ + 1) + mark_++].name(), GL_TIMESTAMP);
}

void TimestampRing::end_frame() {
    assert(mark_ == spans_ + 1);
    ++frame_;
}

const std::vector<double>& TimestampRing::latest() {
    for (; read_ < frame_; ++read_) {
        const Query* marks = &queries_[read_ % depth * (spans_ + 1)];
        GLint finished = GL_FALSE;
        glGetQueryObjectiv(marks[spans_].name(), GL_QUERY_RESULT_AVAILABLE, &finished);
        if (!finished) break;
        latest_.resize(spans_);
        for (std::size_t i = 0; i < spans_; ++i) {
            latest_[i] = result_ms(marks[i + 1].name()) - result_ms(marks[i].name());
        }
    }
    return latest_;
}

} // namespace postfx::gl
