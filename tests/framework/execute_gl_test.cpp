// The executor: does what the plan says.
#include <catch2/catch.hpp>

#include "execute_fixture.hpp"
#include "gl_hooks.hpp"

#include <temporary_directory.hpp>

#include <bit>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>

namespace fs = std::filesystem;
using namespace execute_fixture;
using postfx::testing::TemporaryDirectory;

namespace {

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
        const SceneFacts facts = facts_of(test_picture());
        PlanOptions options = linear_output(format);
        const Plan one = Planner().plan(chain, facts, options);
        const Image fused = draw(chain, test_picture(), facts, options);
        options.fuse = false;
        const Plan five = Planner().plan(chain, facts, options);
        const Image apart = draw(chain, test_picture(), facts, options);
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

TEST_CASE("two instances in one pass have their own values, as uniforms and compiled in") {
    const Quiet quiet;
    Chain chain = chain_of({"tint", "tint"});
    chain.find("tint")->values[1] = {2, 4, 1, 0};
    chain.find("tint")->set("amount", 1);
    chain.find("tint_2")->values[1] = {0.5, 0.5, 3, 0};
    chain.find("tint_2")->set("amount", 1);
    const Image color = postfx::testing::constant(3, 2, {1.0f, 2.0f, 3.0f});
    PlanOptions options = linear_output();
    for (bool fold : {false, true}) {
        options.fold = fold;
        const Image result = draw(chain, color, facts_of(color), options);
        CAPTURE(fold);
        CHECK(result.at(2, 1, 0) == 1);
        CHECK(result.at(2, 1, 1) == 4);
        CHECK(result.at(2, 1, 2) == 9);
    }
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

TEST_CASE("display codes of premultiplied light are those of the light without its alpha") {
    const Quiet quiet;
    Image color(3, 1, 4);
    color.values = {0.5f,  0.5f, 0.5f,  0.5f,  // white, half covered
                    0.25f, 0.0f, 0.0f,  0.0f,  // light without a surface stays as it is
                    0.2f,  0.1f, 0.05f, 1.0f}; // covered wholly
    SceneFacts facts = facts_of(color);
    facts.color_is_8bit = true; // no dither
    PlanOptions options;
    const Image multiplied = draw(Chain{}, color, facts, options);
    options.divide_by_alpha = true;
    const Image divided = draw(Chain{}, color, facts, options);
    for (int channel = 0; channel < 3; ++channel) {
        CHECK(divided.at(0, 0, channel) == 1.0f);
        CHECK(divided.at(1, 0, channel) == multiplied.at(1, 0, channel));
        CHECK(divided.at(2, 0, channel) == multiplied.at(2, 0, channel));
    }
    CHECK(multiplied.at(0, 0, 0) == 188 / 255.0f); // sRGB of one half
    CHECK(divided.at(0, 0, 3) == 128 / 255.0f);
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
    const Plan good = planner.plan(nine_effects(), facts_of(color), linear_output());
    Executor executor;
    executor.prepare(good);
    executor.run(inputs.of(good));
    const Image before = executor.read_picture();

    const Plan bad = planner.plan(chain_of({"tint", "broken_shader"}), facts_of(color), linear_output());
    for (int attempt = 0; attempt < 2; ++attempt) {
        try {
            executor.prepare(bad);
            FAIL("prepared");
        } catch (const postfx::Error& error) {
            INFO(error.what());
            CHECK(error.place().file == "broken_shader.glsl");
            CHECK(error.place().line == 4);
            CHECK(error.place().effect == "tint+broken_shader");
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
    const Plan good = Planner().plan(nine_effects(), facts_of(color), linear_output());
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
    executor.prepare(Planner().plan(chain_of({"tint"}), facts_of(color), linear_output()));
    CHECK_THROWS_WITH(executor.run({}), "the plan reads 1 attachments (color), 0 were given");
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
    const Plan plan = Planner().plan(chain_of({"blur", "tint"}), facts_of(color), linear_output());
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
    CHECK_NOTHROW(executor.prepare(Planner().plan(chain_of({"tint"}), facts_of(color), linear_output())));
}

// ---- compiled-in values

TEST_CASE("folded values give what uniforms give") {
    const Quiet quiet;
    // Every kind of number, every kind of pass; this chain computes nothing that a compiler could round otherwise but
    // contractions, so that a float step for each of its operations is more than enough.
    const Chain chain = chain_of({"blur", "shift", "tint", "plain_c", "tint", "gauge"});
    PlanOptions folded = linear_output();
    folded.fold = true;
    SceneFacts facts = facts_of(test_picture());
    const Image live = draw(chain, test_picture(), facts);
    CHECK(worst_steps(draw(chain, test_picture(), facts, folded), live, float_step) <= 16);

    const Image black(15, 2, 3);
    facts = facts_of(black);
    const Image packed = draw(chain_of({"tint", "pack"}), black, facts);
    CHECK(postfx::testing::same_bits(draw(chain_of({"tint", "pack"}), black, facts, folded), packed));
}

// ---- watching for what is no number

TEST_CASE("the first pass that makes a NaN is named") {
    const Quiet quiet;
    Image color = postfx::testing::constant(21, 9, {2.0f, 2.0f, 2.0f});
    color.at(3, 4, 1) = 0.5f;
    color.at(20, 8, 2) = 0.5f;
    Chain chain = chain_of({"tint", "spoil"});
    chain.find("spoil")->set("threshold", 1);
    const Inputs inputs(color);
    const Plan plan = Planner().plan(chain, facts_of(color), linear_output());
    Executor executor;
    executor.prepare(plan);

    executor.run(inputs.of(plan));
    CHECK(!executor.report().nonfinite); // it costs: off unless asked for

    for (int frame = 0; frame < 2; ++frame) { // counts of the frame before are forgotten
        executor.run(inputs.of(plan), postfx::Timing::off, postfx::Watch::nonfinite);
        const auto found = executor.report().nonfinite;
        REQUIRE(found);
        REQUIRE(found->size() == 3);
        CHECK((*found)[0].name == "spoil/roots");
        CHECK((*found)[0].made_here);
        CHECK((*found)[0].pixels == 2);
        CHECK((*found)[0].x == 3);
        CHECK((*found)[0].y == 4);
        CHECK((*found)[1].name == "spoil/squares");
        CHECK(!(*found)[1].made_here);
        CHECK(!(*found)[2].made_here);
    }
}

TEST_CASE("a NaN of the input is nobody's fault") {
    const Quiet quiet;
    Image color = postfx::testing::constant(5, 5, {2.0f, 2.0f, 2.0f});
    color.at(1, 2, 0) = std::numeric_limits<float>::infinity();
    const Inputs inputs(color);
    const Plan plan = Planner().plan(chain_of({"tint"}), facts_of(color), linear_output());
    Executor executor;
    executor.prepare(plan);
    executor.run(inputs.of(plan), postfx::Timing::profile, postfx::Watch::nonfinite);
    const auto found = executor.report().nonfinite;
    REQUIRE(found);
    REQUIRE(found->size() == 2);
    CHECK((*found)[0].name == "color");
    CHECK(!(*found)[0].made_here);
    CHECK((*found)[1].name == "tint");
    CHECK(!(*found)[1].made_here);
}

TEST_CASE("the program cache forgets what was not used longest") {
    const TemporaryDirectory scratch;
    for (int i = 0; i < 1001; ++i)
        std::ofstream(scratch.path() / ("old_" + std::to_string(i) + ".program")) << "old";
    const fs::path kept = scratch.path() / "note.txt", oldest = scratch.path() / "old_7.program";
    std::ofstream(kept) << "not a program";
    fs::last_write_time(oldest, fs::file_time_type::clock::now() - std::chrono::hours(1));
    const Executor executor(scratch.path());
    CHECK(files_in(scratch.path()).size() == 500 + 1);
    CHECK(fs::exists(kept));
    CHECK(!fs::exists(oldest));
}
