// The executor costs what it promises: steady frames without allocations or new GL objects, and honest times.
#include <catch2/catch.hpp>

#include "execute_fixture.hpp"
#include "gl_hooks.hpp"

#include <cstdlib>
#include <ctime>
#include <iostream>
#include <new>

using namespace execute_fixture;
using postfx::Timing;

// ---- heap allocations of this thread

namespace {

thread_local long allocations = 0;

void* allocate(std::size_t size) {
    ++allocations;
    if (void* memory = std::malloc(size ? size : 1)) return memory;
    throw std::bad_alloc();
}

} // namespace

void* operator new(std::size_t size) {
    return allocate(size);
}
void* operator new[](std::size_t size) {
    return allocate(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    return std::malloc(size ? size : 1);
}
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
    ++allocations;
    return std::malloc(size ? size : 1);
}
void operator delete(void* memory) noexcept {
    std::free(memory);
}
void operator delete[](void* memory) noexcept {
    std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
    std::free(memory);
}
void operator delete[](void* memory, std::size_t) noexcept {
    std::free(memory);
}

// ---- steady frames

TEST_CASE("a steady frame allocates nothing and makes no GL object") {
    const Quiet quiet;
    const Image color = test_picture();
    const Inputs inputs(color);
    const Plan plan = Planner().plan(nine_effects(), facts_of(color), linear_output());
    for (const Timing timing : {Timing::off, Timing::gpu, Timing::profile}) {
        Executor executor;
        executor.prepare(plan);
        postfx::FrameInputs frame = inputs.of(plan);
        for (int i = 0; i < 2; ++i)
            executor.run(frame, timing);
        const postfx::testing::GlCreations creations;
        const long before = allocations;
        for (int i = 0; i < 100; ++i) {
            frame.frame = static_cast<std::uint32_t>(i);
            frame.time = i / 60.0;
            executor.run(frame, timing);
        }
        CHECK(allocations - before == 0);
        CHECK(creations.calls() == 0);
    }
}

TEST_CASE("new values of the same plan make no GL object") {
    const Quiet quiet;
    const Image color = test_picture();
    const Inputs inputs(color);
    Chain chain = nine_effects();
    Planner planner;
    Executor executor;
    executor.prepare(planner.plan(chain, facts_of(color), linear_output()));
    chain.find("tint")->set("amount", 0.75);
    const Plan changed = planner.plan(chain, facts_of(color), linear_output());
    {
        const postfx::testing::GlCreations creations;
        executor.prepare(changed);
        executor.run(inputs.of(changed));
        CHECK(creations.calls() == 0);
    }
    CHECK(postfx::testing::same_bits(executor.read_picture(), draw(chain, color, facts_of(color))));
}

TEST_CASE("back and forth between plans of one size, targets are taken over") {
    const Quiet quiet;
    const Image color = test_picture();
    const Inputs inputs(color);
    const Plan long_plan = Planner().plan(nine_effects(), facts_of(color), linear_output());
    const Plan short_plan = Planner().plan(chain_of({"blur"}), facts_of(color), linear_output());
    Executor executor;
    executor.prepare(long_plan);
    executor.run(inputs.of(long_plan));
    const Image before = executor.read_picture();
    {
        const POSTFX_GL_HOOK(glTextureStorage2D) storage;
        executor.prepare(short_plan);
        CHECK(storage.calls() == 0);
    }
    executor.prepare(long_plan);
    executor.run(inputs.of(long_plan));
    CHECK(postfx::testing::same_bits(executor.read_picture(), before));
}

TEST_CASE("outside GL a frame of nine effects costs at most 100 microseconds of CPU") {
    const Quiet quiet;
    const Image color = test_picture();
    const Inputs inputs(color);
    const Plan plan = Planner().plan(nine_effects(), facts_of(color), linear_output());
    Executor executor{postfx::ExecutorOptions{.keep_gl_state = false}};
    executor.prepare(plan);
    const postfx::FrameInputs frame = inputs.of(plan);
    executor.run(frame);

    constexpr int frames = 1000;
    const auto cpu_microseconds = [] {
        timespec time{};
        clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
        return static_cast<double>(time.tv_sec) * 1e6 + static_cast<double>(time.tv_nsec) / 1e3;
    };
    double spent = 0;
    {
        const POSTFX_GL_HOOK(glNamedBufferSubData) sub_data(true);
        const POSTFX_GL_HOOK(glBindBufferBase) bind_buffer(true);
        const POSTFX_GL_HOOK(glBindVertexArray) bind_vertex_array(true);
        const POSTFX_GL_HOOK(glDisable) disable(true);
        const POSTFX_GL_HOOK(glColorMask) color_mask(true);
        const POSTFX_GL_HOOK(glPolygonMode) polygon_mode(true);
        const POSTFX_GL_HOOK(glPushDebugGroup) push(true);
        const POSTFX_GL_HOOK(glPopDebugGroup) pop(true);
        const POSTFX_GL_HOOK(glBindFramebuffer) bind_framebuffer(true);
        const POSTFX_GL_HOOK(glViewportIndexedf) viewport(true);
        const POSTFX_GL_HOOK(glDisablei) disable_indexed(true);
        const POSTFX_GL_HOOK(glClipControl) clip_control(true);
        const POSTFX_GL_HOOK(glIsTexture) is_texture;
        const POSTFX_GL_HOOK(glUseProgram) use_program(true);
        const POSTFX_GL_HOOK(glBindTextureUnit) bind_texture(true);
        const POSTFX_GL_HOOK(glBindSampler) bind_sampler(true);
        const POSTFX_GL_HOOK(glDrawArrays) draw_arrays(true);
        const double start = cpu_microseconds();
        for (int i = 0; i < frames; ++i)
            executor.run(frame);
        spent = (cpu_microseconds() - start) / frames;
        CHECK(draw_arrays.calls() == frames * static_cast<int>(plan.passes.size()));
    }
    std::cout << "run() of nine effects outside GL: " << spent << " microseconds of CPU per frame\n";
    CHECK(spent <= 100); // what the project promises
}

// ---- time

TEST_CASE("profile mode gives the CPU time of every pass and says which clock it is") {
    const Quiet quiet;
    const Image color = test_picture(200, 200);
    const Inputs inputs(color);
    const Plan plan = Planner().plan(nine_effects(), facts_of(color), linear_output());
    Executor executor;
    executor.prepare(plan);
    executor.run(inputs.of(plan));
    CHECK(executor.report().clock == "none: times were not asked for");
    CHECK_FALSE(executor.report().passes[0].cpu_ms);

    executor.run(inputs.of(plan), Timing::profile);
    const postfx::Report report = executor.report();
    REQUIRE(report.passes.size() == plan.passes.size());
    for (const postfx::PassReport& pass : report.passes) {
        INFO(pass.name);
        REQUIRE(pass.cpu_ms);
        REQUIRE(pass.wall_ms);
        CHECK(*pass.wall_ms > 0);
        CHECK(*pass.cpu_ms > 0);
        CHECK_FALSE(pass.gpu_ms);
    }
    CHECK(report.clock.starts_with("CPU time of all threads and wall time around each finished pass"));
}

TEST_CASE("gpu mode gives times where the clock is honest, and says so where it is not") {
    const Quiet quiet;
    const Image color = test_picture();
    const Inputs inputs(color);
    const Plan plan = Planner().plan(nine_effects(), facts_of(color), linear_output());
    Executor executor;
    executor.prepare(plan);
    // The host's state must not reach the draw that checks the clock.
    glEnable(GL_RASTERIZER_DISCARD);
    for (int i = 0; i < 10; ++i) {
        executor.run(inputs.of(plan), Timing::gpu);
        glFinish();
    }
    const postfx::Report report = executor.report();
    const bool lies = gl::current_device().software;
    INFO(report.clock);
    CHECK(report.clock.starts_with(lies ? "none to be believed: GL timer queries read " : "GL timestamps"));
    for (const postfx::PassReport& pass : report.passes)
        CHECK(pass.gpu_ms.has_value() == !lies);
}
