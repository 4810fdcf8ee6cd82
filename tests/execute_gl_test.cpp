// The executor: does what the plan says, and costs what it promises.
#include <catch2/catch.hpp>

#include "fixtures.hpp"
#include "gl_hooks.hpp"

#include <gl/context.hpp>
#include <gl/objects.hpp>
#include <temporary_directory.hpp>
#include <testing.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <limits>
#include <new>
#include <string>
#include <vector>

namespace fs = std::filesystem;
namespace gl = postfx::gl;
using postfx::Chain;
using postfx::Executor;
using postfx::Facts;
using postfx::Format;
using postfx::Image;
using postfx::Plan;
using postfx::Planner;
using postfx::Timing;
using postfx::testing::fixtures;
using postfx::testing::TemporaryDirectory;

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

namespace {

Facts facts_of(const Image& color, Format working = Format::rgba32f) {
    Facts facts;
    facts.width = color.width;
    facts.height = color.height;
    facts.working_format = working;
    facts.output = postfx::Output::linear;
    facts.attachments = {"color", "depth"};
    return facts;
}

Chain chain_of(const std::vector<std::string>& effects) {
    Chain chain;
    for (const std::string& effect : effects)
        chain.add(fixtures(), effect);
    return chain;
}

/// Nine effects with every kind of pass.
Chain nine_effects() {
    return chain_of({"blur", "tint", "split", "plain_c", "shift", "tint", "curve", "many", "gauge"});
}

Image four_channels(const Image& image) {
    Image result(image.width, image.height, 4, 1.0f);
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        std::copy_n(&image.values[3 * i], 3, &result.values[4 * i]);
    return result;
}

/// Input textures for any plan of the fixtures.
class Inputs {
public:
    explicit Inputs(const Image& color)
        : color_(color.width, color.height, Format::rgba32f),
          depth_(color.width, color.height, Format::r32f) {
        color_.upload(color.channels == 4 ? color : four_channels(color));
        depth_.upload(postfx::testing::constant(color.width, color.height, {0.25f}));
    }
    postfx::FrameInputs of(const Plan& plan) const {
        postfx::FrameInputs inputs;
        for (const std::string& name : plan.attachments)
            inputs.textures.push_back(name == "depth" ? depth_.name() : color_.name());
        return inputs;
    }

private:
    gl::Texture color_, depth_;
};

Image draw(const Chain& chain, const Image& color, const Facts& facts) {
    const Inputs inputs(color);
    const Plan plan = Planner().plan(chain, facts);
    Executor executor;
    executor.prepare(plan);
    executor.run(inputs.of(plan));
    return executor.read_picture();
}

/// Distance of two neighbouring half floats near x.
double half_step(double x) {
    const int exponent = x == 0 ? -14 : std::max(-14, std::ilogb(x));
    return std::ldexp(1.0, exponent - 10);
}

double float_step(double x) {
    const int exponent = x == 0 ? -126 : std::max(-126, std::ilogb(x));
    return std::ldexp(1.0, exponent - 23);
}

/// The largest difference in steps of the larger value.
double worst_steps(const Image& a, const Image& b, double (*step)(double)) {
    REQUIRE(a.values.size() == b.values.size());
    double worst = 0;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const double x = a.values[i], y = b.values[i];
        REQUIRE(std::isfinite(x));
        REQUIRE(std::isfinite(y));
        worst = std::max(worst, std::abs(x - y) / step(std::max(std::abs(x), std::abs(y))));
    }
    return worst;
}

Image test_picture(int width = 67, int height = 41) {
    return postfx::testing::noise(width, height, 0, 4, 5);
}

/// Every test ends with nothing to complain about.
struct Quiet {
    Quiet() { gl::take_debug_messages(); }
    ~Quiet() {
        for (const std::string& message : gl::take_debug_messages())
            FAIL_CHECK("OpenGL says: " << message);
    }
};

std::vector<fs::path> files_in(const fs::path& directory) {
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(directory))
        files.push_back(entry.path());
    return files;
}

} // namespace

// ---- pixels

TEST_CASE("fused is unfused, within two half-float steps per rounding removed") {
    const Quiet quiet;
    const Chain chain = chain_of({"shift", "tint", "plain_c", "tint", "curve"});
    for (const Format format : {Format::rgba16f, Format::rgba32f}) {
        Facts facts = facts_of(test_picture(), format);
        const Plan one = Planner().plan(chain, facts);
        const Image fused = draw(chain, test_picture(), facts);
        facts.fuse = false;
        const Plan five = Planner().plan(chain, facts);
        const Image apart = draw(chain, test_picture(), facts);
        REQUIRE(one.passes.size() == 1);
        REQUIRE(five.passes.size() == 5);
        // Each effect here at most keeps a relative error, so each rounding between passes counts once; a compiler
        // may also contract multiplications and additions of one pass, which costs less than a step.
        const auto step = format == Format::rgba16f ? half_step : float_step;
        CHECK(worst_steps(fused, apart, step) <= 2.0 * 4);
    }
}

TEST_CASE("a chain of identities gives the input bit for bit") {
    const Quiet quiet;
    Image odd(8, 1, 4, 1.0f);
    const std::uint32_t bits[] = {0x80000000u, 0x7fc12345u, 0xffc00001u, 0x7f800000u,
                                  0xff800000u, 0x00000001u, 0x807fffffu, 0x7f7fffffu};
    for (int x = 0; x < 8; ++x)
        odd.at(x, 0, 0) = std::bit_cast<float>(bits[x]);
    Chain chain = chain_of({"tint", "shift", "blur", "plain_c"});
    chain.find("tint")->set("amount", 0);
    chain.find("shift")->set("pixels", 0);
    chain.find("blur")->set("radius", 0);
    chain.find("plain_c")->set("gain", 1);
    CHECK(postfx::testing::same_bits(draw(chain, odd, facts_of(odd)), odd));
}

TEST_CASE("every number of a parameter struct arrives") {
    const Quiet quiet;
    const Image black(15, 2, 3);
    // Behind tint, so that the struct does not begin at the block's first struct.
    const Image result = draw(chain_of({"tint", "pack"}), black, facts_of(black));
    const float expected[15] = {1, 2, 3, 4, 1, -6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    for (int x = 0; x < 15; ++x) {
        CHECK(result.at(x, 1, 0) == expected[x]);
        CHECK(result.at(x, 1, 1) == -16);
    }
}

TEST_CASE("two instances in one pass have their own values") {
    const Quiet quiet;
    Chain chain = chain_of({"tint", "tint"});
    chain.find("tint")->values[1] = {2, 4, 1, 0};
    chain.find("tint")->set("amount", 1);
    chain.find("tint_2")->values[1] = {0.5, 0.5, 3, 0};
    chain.find("tint_2")->set("amount", 1);
    const Image color = postfx::testing::constant(3, 2, {1.0f, 2.0f, 3.0f});
    const Image result = draw(chain, color, facts_of(color));
    CHECK(result.at(2, 1, 0) == 1);
    CHECK(result.at(2, 1, 1) == 4);
    CHECK(result.at(2, 1, 2) == 9);
}

TEST_CASE("a pass with two outputs writes both") {
    const Quiet quiet;
    Image color(2, 1, 3);
    const float values[] = {1, 0.25f, 3, /* bright: */ 4, 0.75f, 6};
    std::copy(std::begin(values), std::end(values), color.values.begin());
    const Image result = draw(chain_of({"split"}), color, facts_of(color));
    const float expected[] = {1, 0.25f, 3, 6, 0.75f, 4};
    for (int x = 0; x < 2; ++x) {
        for (int c = 0; c < 3; ++c)
            CHECK(result.at(x, 0, c) == expected[3 * x + c]);
    }
}

TEST_CASE("attachments and alpha come through") {
    const Quiet quiet;
    Image color(2, 2, 4, 0.5f);
    color.at(1, 1, 3) = 0.125f;
    const Image result = draw(chain_of({"gauge"}), color, facts_of(color));
    CHECK(result.at(1, 1, 0) == 0.75f);
    CHECK(result.at(1, 1, 3) == 0.125f);
}

TEST_CASE("what the host left switched on changes nothing") {
    const Quiet quiet;
    const Image color = test_picture();
    const Chain chain = nine_effects();
    const Image clean = draw(chain, color, facts_of(color));

    const GLenum switches[] = {GL_BLEND,      GL_DEPTH_TEST,       GL_STENCIL_TEST,       GL_SCISSOR_TEST,
                               GL_CULL_FACE,  GL_FRAMEBUFFER_SRGB, GL_RASTERIZER_DISCARD, GL_COLOR_LOGIC_OP,
                               GL_SAMPLE_MASK};
    for (GLenum s : switches)
        glEnable(s);
    glScissor(0, 0, 1, 1);
    glBlendFunc(GL_ZERO, GL_ZERO);
    glDepthFunc(GL_NEVER);
    glStencilFunc(GL_NEVER, 0, 0);
    glCullFace(GL_FRONT_AND_BACK);
    glLogicOp(GL_CLEAR);
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
    const Image dirty = draw(chain, color, facts_of(color));

    for (GLenum s : switches)
        glDisable(s);
    glBlendFunc(GL_ONE, GL_ZERO);
    glDepthFunc(GL_LESS);
    glStencilFunc(GL_ALWAYS, 0, ~0u);
    glCullFace(GL_BACK);
    glLogicOp(GL_COPY);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    CHECK(postfx::testing::same_bits(dirty, clean));
}

TEST_CASE("a chain of the most entries that a file may have is drawn") {
    const Quiet quiet;
    Chain chain;
    for (std::size_t i = 0; i < postfx::max_chain_entries; ++i) {
        chain.add(fixtures(), "plain_c").values[0][0] = i % 2 ? 2.0 : 0.5;
        chain.entries.back().name = "an_entry_with_a_long_name_" + std::to_string(i);
    }
    const Image color = postfx::testing::constant(2, 2, {1.0f, 2.0f, 3.0f});
    const Image result = draw(chain, color, facts_of(color));
    CHECK(result.at(1, 1, 2) == 3);
}

// ---- what goes wrong

TEST_CASE("a shader that does not compile is named by its own file and line, and the plan before draws on") {
    const Quiet quiet;
    const Image color = test_picture();
    const Inputs inputs(color);
    Planner planner;
    const Plan good = planner.plan(nine_effects(), facts_of(color));
    Executor executor;
    executor.prepare(good);
    executor.run(inputs.of(good));
    const Image before = executor.read_picture();

    const Plan bad = planner.plan(chain_of({"tint", "broken_shader"}), facts_of(color));
    for (int attempt = 0; attempt < 2; ++attempt) {
        try {
            executor.prepare(bad);
            FAIL("prepared");
        } catch (const postfx::Error& error) {
            INFO(error.what());
            CHECK(error.place().file == "broken_shader.glsl");
            CHECK(error.place().line == 4);
            CHECK(error.message().starts_with("tint+broken_shader: "));
            CHECK(error.message().find("no_such_variable") != std::string::npos);
            CHECK(std::string(error.what()).find('\n') == std::string::npos);
        }
    }
    gl::take_debug_messages(); // Mesa repeats the compiler's errors there
    executor.run(inputs.of(good));
    CHECK(postfx::testing::same_bits(executor.read_picture(), before));
}

TEST_CASE("a plan whose targets can't be had leaves the plan before as it was") {
    const Quiet quiet;
    const Image color = test_picture();
    const Inputs inputs(color);
    const Plan good = Planner().plan(nine_effects(), facts_of(color));
    Executor executor;
    executor.prepare(good);
    executor.run(inputs.of(good));
    const Image before = executor.read_picture();

    Plan impossible = good;
    impossible.targets.back().width = 1 << 20;
    CHECK_THROWS_AS(executor.prepare(impossible), postfx::Error);
    executor.run(inputs.of(good));
    CHECK(postfx::testing::same_bits(executor.read_picture(), before));
}

TEST_CASE("wrong use is an Error") {
    const Quiet quiet;
    Executor executor;
    CHECK_THROWS_WITH(executor.run({}), "run() before any prepare()");
    CHECK_THROWS_WITH(executor.read_picture(), "read_picture() before any run()");
    const Image color = test_picture();
    executor.prepare(Planner().plan(chain_of({"tint"}), facts_of(color)));
    CHECK_THROWS_WITH(executor.run({}), "the plan reads 1 attachments, 0 were given");
}

TEST_CASE("no compose function reaches what others in its pass see") {
    const Quiet quiet;
    const Image color = test_picture();
    CHECK(postfx::testing::same_bits(draw(chain_of({"sneaky_redefine"}), color, facts_of(color)), color));
    // A function that takes the pixel to change it does not compile.
    CHECK_THROWS_AS(draw(chain_of({"sneaky_move", "gauge"}), color, facts_of(color)), postfx::Error);
    gl::take_debug_messages();
}

// ---- the program cache

TEST_CASE("programs on disk are loaded, not compiled, and bad files are ignored") {
    const Quiet quiet;
    GLint formats = 0;
    glGetIntegerv(GL_NUM_PROGRAM_BINARY_FORMATS, &formats);
    if (formats == 0) {
        WARN("this driver gives no program binaries: nothing to test");
        return;
    }
    const TemporaryDirectory scratch;
    const Image color = test_picture();
    const Inputs inputs(color);
    const Plan plan = Planner().plan(chain_of({"blur", "tint"}), facts_of(color));
    const auto compiled_by_new_executor = [&](Image* picture) {
        POSTFX_GL_HOOK(glCompileShader) hook;
        Executor executor(scratch / "programs");
        executor.prepare(plan);
        executor.run(inputs.of(plan));
        *picture = executor.read_picture();
        return hook.calls();
    };
    Image first, later;
    CHECK(compiled_by_new_executor(&first)
          == 4); // two programs (blur's line is used twice), two shaders each
    const std::vector<fs::path> files = files_in(scratch / "programs");
    REQUIRE(files.size() == 2);
    CHECK(compiled_by_new_executor(&later) == 0);
    CHECK(postfx::testing::same_bits(later, first));

    const auto spoil = [&](auto change) {
        for (const fs::path& file : files) {
            std::string bytes = postfx::testing::file_bytes(file);
            change(bytes);
            postfx::testing::put_bytes(file, bytes);
        }
        CHECK(compiled_by_new_executor(&later) == 4); // and writes good files again
        CHECK(postfx::testing::same_bits(later, first));
    };
    spoil([](std::string& bytes) { bytes.clear(); });
    spoil([](std::string& bytes) { bytes.resize(bytes.size() / 2); });
    spoil([](std::string& bytes) { bytes = std::string(bytes.size(), '\x5a'); });
    spoil([](std::string& bytes) { bytes[0] ^= 0x55; });                          // another binary format
    spoil([](std::string& bytes) { bytes[bytes.size() - 100] ^= 0x55; });         // a bit of the binary
    spoil([](std::string& bytes) { bytes[20] ^= 0x01; });                         // another shader's text
    spoil([](std::string& bytes) { std::fill_n(bytes.begin() + 4, 8, '\xff'); }); // an absurd length
    CHECK(compiled_by_new_executor(&later) == 0);
}

TEST_CASE("a cache that can't be written does no harm") {
    const Quiet quiet;
    const TemporaryDirectory scratch;
    postfx::testing::put_bytes(scratch / "file", "in the way");
    Executor executor(scratch / "file" / "programs");
    const Image color = test_picture();
    CHECK_NOTHROW(executor.prepare(Planner().plan(chain_of({"tint"}), facts_of(color))));
}

// ---- steady frames

TEST_CASE("a steady frame allocates nothing and makes no GL object") {
    const Quiet quiet;
    const Image color = test_picture();
    const Inputs inputs(color);
    const Plan plan = Planner().plan(nine_effects(), facts_of(color));
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
    executor.prepare(planner.plan(chain, facts_of(color)));
    chain.find("tint")->set("amount", 0.75);
    const Plan changed = planner.plan(chain, facts_of(color));
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
    const Plan long_plan = Planner().plan(nine_effects(), facts_of(color));
    const Plan short_plan = Planner().plan(chain_of({"blur"}), facts_of(color));
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
    const Plan plan = Planner().plan(nine_effects(), facts_of(color));
    Executor executor;
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
        const POSTFX_GL_HOOK(glViewport) viewport(true);
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
    const Plan plan = Planner().plan(nine_effects(), facts_of(color));
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
    const Plan plan = Planner().plan(nine_effects(), facts_of(color));
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
