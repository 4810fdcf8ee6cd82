// The GL room: context, objects, program errors, clocks, debug output.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include <gl/clock.hpp>
#include <gl/context.hpp>
#include <gl/objects.hpp>
#include <gl/program_log.hpp>

#include <postfx/error.hpp>

#include <testing.hpp>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>

using namespace postfx;

namespace {

std::unique_ptr<gl::HeadlessContext> context;

constexpr std::string_view full_screen = R"(#version 450 core
void main() {
    gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0);
}
)";

const std::vector<std::string> two_files = {"first.glsl", "second.glsl"};

std::vector<std::uint32_t> bits(const std::vector<float>& values) {
    std::vector<std::uint32_t> words(values.size());
    std::memcpy(words.data(), values.data(), values.size() * sizeof(float));
    return words;
}

float from_bits(std::uint32_t word) {
    float value = 0;
    std::memcpy(&value, &word, sizeof value);
    return value;
}

/// Draw one triangle over all of `target` with that fragment shader.
void draw_over(const gl::Texture& target, std::string_view fragment) {
    const gl::Framebuffer framebuffer = gl::make_framebuffer({target.name()});
    const gl::Program program = gl::make_program(full_screen, fragment, "test");
    const gl::VertexArray vertex_array = gl::make_vertex_array();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
    glViewport(0, 0, target.width(), target.height());
    glUseProgram(program.name());
    glBindVertexArray(vertex_array.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

Error error_of(std::string_view fragment, const std::vector<std::string>& files) {
    try {
        gl::make_program(full_screen, fragment, "the program", files);
    } catch (const Error& error) {
        gl::take_debug_messages(); // the driver says it there as well
        return error;
    }
    FAIL("it compiled");
    return Error("");
}

/// A 5x3 image (odd, so that rows are not aligned to 4 bytes in any 8-bit format) of values that every float
/// format and, within half a code, every 8-bit format holds.
Image gradient(int channels) {
    Image image(5, 3, channels);
    for (std::size_t i = 0; i < image.values.size(); ++i)
        image.values[i] = static_cast<float>(i % 33) / 32.0f;
    return image;
}

} // namespace

TEST_CASE("the context says what it is") {
    const gl::DeviceInfo& device = context->device();
    CHECK_FALSE(device.vendor.empty());
    CHECK_FALSE(device.renderer.empty());
    CHECK(device.version.find('.') != std::string::npos);
    CHECK(device.platform.substr(0, 4) == "EGL ");
    CHECK(device.software == (device.renderer.find("llvmpipe") != std::string::npos));
}

TEST_CASE("a second context does not take the first with it") {
    { const gl::HeadlessContext other; }
    context = std::make_unique<gl::HeadlessContext>(true);
    const gl::Texture texture(1, 1, Format::r8);
    CHECK(glIsTexture(texture.name()));
}

TEST_CASE("what goes into a texture comes out") {
    const Format format = static_cast<Format>(GENERATE(range(0, 11)));
    const FormatInfo& info = format_info(format);
    CAPTURE(info.name);
    const Image image = gradient(info.channels);
    gl::Texture texture(image.width, image.height, format);
    texture.upload(image);
    const Image back = gl::read_texture(texture.name(), image.width, image.height, format);
    REQUIRE(back.channels == info.channels);
    // 8 bits: half a code. Floats: multiples of 1/32 up to 1 need 5 bits of mantissa; the smallest format
    // has 5.
    const bool codes = info.bytes_per_pixel == info.channels;
    const double tolerance = codes ? 0.5 / 255 + 1e-6 : 0;
    double worst = 0;
    for (std::size_t i = 0; i < image.values.size(); ++i) {
        worst = std::max(worst, std::fabs(static_cast<double>(back.values[i]) - image.values[i]));
    }
    CHECK(worst <= tolerance);
}

TEST_CASE("32-bit floats keep every bit") {
    const Format format = GENERATE(Format::r32f, Format::rg32f, Format::rgba32f);
    CAPTURE(format_info(format).name);
    const std::vector<float> special = {from_bits(0x7fc12345),
                                        from_bits(0xffc54321),
                                        from_bits(0x7f812345),
                                        std::numeric_limits<float>::infinity(),
                                        -0.0f,
                                        std::numeric_limits<float>::denorm_min(),
                                        std::numeric_limits<float>::max(),
                                        -1.0f};
    const int channels = format_info(format).channels;
    Image image(8 / channels, 1, channels);
    image.values = special;
    gl::Texture texture(image.width, image.height, format);
    texture.upload(image);
    CHECK(bits(gl::read_texture(texture.name(), image.width, 1, format).values) == bits(special));
}

TEST_CASE("channels that an image lacks become 0 and alpha 1") {
    gl::Texture texture(2, 1, Format::rgba32f);
    Image image(2, 1, 2, 0.25f);
    texture.upload(image);
    const std::vector<float> expected = {0.25f, 0.25f, 0, 1, 0.25f, 0.25f, 0, 1};
    CHECK(gl::read_texture(texture.name(), 2, 1, Format::rgba32f).values == expected);
    CHECK_THROWS_AS(gl::Texture(2, 1, Format::r8).upload(image), Error);
    CHECK_THROWS_AS(gl::Texture(3, 1, Format::rg8).upload(image), Error);
    CHECK_THROWS_AS(gl::Texture(1 << 20, 1, Format::r8), Error);
    CHECK_THROWS_AS(gl::Texture(0, 1, Format::r8), Error);
}

TEST_CASE("a program draws into a framebuffer, bottom row first") {
    const gl::Texture target(3, 2, Format::rgba8);
    draw_over(target, R"(#version 450 core
out vec4 o_color;
void main() { o_color = vec4(floor(gl_FragCoord.xy) * vec2(10.0, 100.0) / 255.0, 0.0, 1.0); }
)");
    const std::vector<unsigned char> expected = {0, 0,   0, 10, 0,   0, 20, 0,   0, //
                                                 0, 100, 0, 10, 100, 0, 20, 100, 0};
    CHECK(gl::read_texture_codes(target.name(), 3, 2, 3) == expected);
}

TEST_CASE("a framebuffer takes several colours and depth, and refuses depth as colour") {
    const gl::Texture a(4, 4, Format::rgba16f), b(4, 4, Format::r11g11b10f), depth(4, 4, Format::depth32f);
    CHECK(gl::make_framebuffer({a.name(), b.name()}, depth.name()));
    CHECK(gl::make_framebuffer({}, depth.name()));
    CHECK_THROWS_AS(gl::make_framebuffer({depth.name()}), Error);
}

TEST_CASE("handles move") {
    gl::Texture a(2, 1, Format::r8);
    const GLuint name = a.name();
    gl::Texture b;
    CHECK_FALSE(b);
    b = std::move(a);
    CHECK(b.name() == name);
    CHECK(b.width() == 2);
    b = gl::Texture();
    CHECK_FALSE(glIsTexture(name));
}

TEST_CASE("a compile error names the author's file and line") {
    const std::string wrong = R"(#version 450 core
out vec4 o_color;
#line 41 1
float wrong() {
    return undeclared_thing;
}
#line 1 0
void main() { o_color = vec4(wrong()); }
)";
    const Error error = error_of(wrong, two_files);
    CHECK(error.place().file == "second.glsl");
    CHECK(error.place().line == 42);
    CHECK(error.message().find("undeclared_thing") != std::string::npos);
    CHECK(error.message().find("the program") == 0);

    const Error unmapped = error_of(wrong, {});
    CHECK(unmapped.place().file.empty());
    CHECK(unmapped.message().find("undeclared_thing") != std::string::npos);
}

TEST_CASE("a link error names the program") {
    const Error error = error_of(R"(#version 450 core
out vec4 o_color;
vec4 never_defined();
void main() { o_color = never_defined(); }
)",
                                 two_files);
    CHECK(error.message().find("never_defined") != std::string::npos);
    CHECK(error.message().find("the program") == 0);
}

TEST_CASE("#line directives are followed and kept from the driver") {
    const gl::NumberedSource source("#version 450\n#line 7 1\na\nb\n  #  line 20\nc");
    CHECK(source.text() == "#version 450\n\na\nb\n\nc");
    const auto check = [&](int line, std::size_t file, int number) {
        CAPTURE(line);
        CHECK(source.origin(line).file == file);
        CHECK(source.origin(line).line == number);
    };
    check(1, 0, 1);
    check(3, 1, 7);
    check(4, 1, 8);
    check(6, 1, 20); // no source string: the same
    check(99, 1, 20);
}

TEST_CASE("the logs of several drivers are understood") {
    struct Row {
        std::string log, file;
        int line, column;
        std::string message;
    };
    const Row row = GENERATE(
        Row{"0:3(5): error: `x' undeclared\n", "second.glsl", 17, 5, "p: error: `x' undeclared"},
        Row{"0:1(1): warning: unused\n0:4(2): error: wrong\n", "second.glsl", 18, 2, "p: error: wrong"},
        Row{"0(1) : error C1503: undefined variable \"x\"\n0(2) : error C1: y", "first.glsl", 1, 0,
            "p: error C1503: undefined variable \"x\""},
        Row{"ERROR: 0:3: 'x' : undeclared identifier", "second.glsl", 17, 0,
            "p: 'x' : undeclared identifier"},
        Row{"0:6(1): error: elsewhere", "", 0, 0, "p: 0:6(1): error: elsewhere"},
        Row{"error: no place at all", "", 0, 0, "p: error: no place at all"},
        Row{"", "", 0, 0, "p: the driver gives no reason"});
    CAPTURE(row.log);
    const gl::NumberedSource source("a\n#line 17 1\nb\nc\n#line 1 9\nd\n");
    const Error error = gl::program_error(row.log, "p", source, two_files);
    CHECK(error.place().file == row.file);
    CHECK(error.place().line == row.line);
    CHECK(error.place().column == row.column);
    CHECK(error.message() == row.message);
}

TEST_CASE("the clock check finds a lying timer query") {
    gl::ClockCheck check = gl::check_clock();
    // A busy machine can hide the lie from the measurement: ask again.
    for (int again = 0; again < 4 && context->device().software && check.queried_ms > 0.5 * check.wall_ms;
         ++again) {
        check = gl::check_clock();
    }
    CAPTURE(context->device().renderer, check.wall_ms, check.queried_ms, check.text);
    CHECK(check.wall_ms > 0);
    CHECK(check.timer_queries_honest == !context->device().software);
    CHECK((check.queried_ms > 0.5 * check.wall_ms) == check.timer_queries_honest);
    CHECK((check.text == "GL timestamps") == check.timer_queries_honest);
}

TEST_CASE("host time goes on") {
    const gl::HostTime start = gl::HostTime::now();
    gl::HostTime now = start;
    while (now.wall_ms < start.wall_ms + 5)
        now = gl::HostTime::now();
    CHECK(now.cpu_ms > start.cpu_ms);
    CHECK(now.wall_ms < start.wall_ms + 5000); // milliseconds, not another unit
}

TEST_CASE("the timestamp ring gives each span, late") {
    gl::TimestampRing ring(2);
    CHECK(ring.latest().empty());
    for (int frame = 0; frame < 10; ++frame) { // more frames than it holds, without reading
        ring.begin_frame();
        for (int mark = 0; mark < 3; ++mark)
            ring.mark();
        ring.end_frame();
    }
    glFinish();
    const std::vector<double>& spans = ring.latest();
    REQUIRE(spans.size() == 2);
    for (double span : spans) {
        CHECK(span >= 0);
        CHECK(span < 1000); // nothing was drawn
    }
}

TEST_CASE("debug output is collected, once") {
    CHECK(gl::take_debug_messages().empty());
    {
        const gl::DebugGroup outer("outer");
        const gl::DebugGroup inner("inner");
        GLint depth = 0;
        glGetIntegerv(GL_DEBUG_GROUP_STACK_DEPTH, &depth);
        CHECK(depth == 3); // the default group counts
    }
    CHECK(gl::take_debug_messages().empty()); // groups are notifications
    glEnable(GL_VENDOR);
    const std::vector<std::string> messages = gl::take_debug_messages();
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].substr(0, 12) == "error (high)");
    CHECK(gl::take_debug_messages().empty());
    glGetError();
}

int main(int argc, char** argv) {
    try {
        context = std::make_unique<gl::HeadlessContext>(true);
    } catch (const Error& error) {
        return postfx::testing::skipped(error.what());
    }
    const int failed = Catch::Session().run(argc, argv);
    const std::vector<std::string> messages = gl::take_debug_messages();
    for (const std::string& message : messages)
        std::fprintf(stderr, "GL said: %s\n", message.c_str());
    context.reset();
    return failed != 0 || !messages.empty() ? 1 : 0;
}
