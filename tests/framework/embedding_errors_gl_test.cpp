// What an executor refuses instead of drawing a wrong picture, and where it draws when it is told to.
#include <catch2/catch.hpp>

#include "execute_fixture.hpp"

#include <cmath>
#include <functional>
#include <limits>

using namespace execute_fixture;
using Catch::Matchers::Contains;
using postfx::Error;
using postfx::FrameInputs;
using postfx::OutputTarget;
using postfx::testing::same_bits;

namespace {

/// One executor with a plan that reads "color", and inputs that fit.
struct Drawing {
    Image color = test_picture();
    Inputs inputs{color};
    Plan plan = Planner().plan(chain_of({"tint"}), facts_of(color), linear_output());
    FrameInputs frame = inputs.of(plan);
    Executor executor;

    Drawing() { executor.prepare(plan); }

    std::string refusal() {
        try {
            executor.run(frame);
        } catch (const Error& error) {
            return error.what();
        }
        return "no error";
    }
};

struct Texture {
    explicit Texture(GLenum target) { glCreateTextures(target, 1, &name); }
    ~Texture() { glDeleteTextures(1, &name); }
    Texture(const Texture&) = delete;
    Texture& operator=(const Texture&) = delete;
    GLuint name = 0;
};

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

} // namespace

TEST_CASE("a texture that is none is refused with its attachment's name") {
    const Quiet quiet;
    Drawing drawing;
    drawing.frame.textures[0] = 0;
    CHECK(drawing.refusal() == "attachment 0 of \"color\": there is no texture: its name is 0");
    drawing.frame.textures[0] = 987654;
    CHECK(drawing.refusal() == "attachment 0 of \"color\": 987654 is no texture of this context");
    drawing.frame.textures.clear();
    CHECK(drawing.refusal() == "the plan reads 1 attachments (color), 0 were given");
    drawing.frame.textures = {1, 1};
    CHECK(drawing.refusal() == "the plan reads 1 attachments (color), 2 were given");
}

TEST_CASE("a texture of another size is refused with both sizes") {
    const Quiet quiet;
    Drawing drawing;
    const gl::Texture smaller(drawing.color.width, drawing.color.height - 1, Format::rgba32f);
    drawing.frame.textures[0] = smaller.name();
    CHECK_THAT(drawing.refusal(), Contains("has 67x40 pixels, the plan is for 67x41"));
    const Texture empty(GL_TEXTURE_2D); // it has no storage yet
    drawing.frame.textures[0] = empty.name;
    CHECK_THAT(drawing.refusal(), Contains("has 0x0 pixels"));
}

TEST_CASE("the size is that of the level that shaders see") {
    const Quiet quiet;
    Drawing drawing;
    const Texture texture(GL_TEXTURE_2D);
    glTextureStorage2D(texture.name, 2, GL_RGBA32F, 2 * drawing.color.width, 2 * drawing.color.height);
    drawing.frame.textures[0] = texture.name;
    CHECK_THAT(drawing.refusal(), Contains("has 134x82 pixels"));
    glTextureParameteri(texture.name, GL_TEXTURE_BASE_LEVEL, 1);
    CHECK(drawing.refusal() == "no error");
}

TEST_CASE("textures of other kinds are refused") {
    const Quiet quiet;
    Drawing drawing;
    const int width = drawing.color.width, height = drawing.color.height;
    const auto refused = [&](GLenum target, const std::function<void(GLuint)>& store, const char* words) {
        const Texture texture(target);
        store(texture.name);
        drawing.frame.textures[0] = texture.name;
        CHECK_THAT(drawing.refusal(), Contains(words));
    };
    refused(
        GL_TEXTURE_2D_ARRAY, [&](GLuint name) { glTextureStorage3D(name, 1, GL_RGBA8, width, height, 2); },
        "an array texture; a 2D texture is expected");
    refused(
        GL_TEXTURE_2D_MULTISAMPLE,
        [&](GLuint name) { glTextureStorage2DMultisample(name, 4, GL_RGBA8, width, height, GL_TRUE); },
        "a multisample texture (resolve it first)");
    refused(
        GL_TEXTURE_RECTANGLE, [&](GLuint name) { glTextureStorage2D(name, 1, GL_RGBA8, width, height); },
        "a rectangle texture");
    refused(
        GL_TEXTURE_CUBE_MAP, [&](GLuint name) { glTextureStorage2D(name, 1, GL_RGBA8, width, width); },
        "a cube map");
    for (GLenum integers : {GL_RGBA8UI, GL_R32I, GL_RG16UI}) {
        refused(
            GL_TEXTURE_2D, [&](GLuint name) { glTextureStorage2D(name, 1, integers, width, height); },
            "holds integers");
    }
    refused(
        GL_TEXTURE_2D, [&](GLuint name) { glTextureStorage2D(name, 1, GL_STENCIL_INDEX8, width, height); },
        "holds integers");
    refused(
        GL_TEXTURE_2D,
        [&](GLuint name) {
            glTextureStorage2D(name, 1, GL_DEPTH24_STENCIL8, width, height);
            glTextureParameteri(name, GL_DEPTH_STENCIL_TEXTURE_MODE, GL_STENCIL_INDEX);
        },
        "holds integers");
}

TEST_CASE("formats that engines have are read") {
    const Quiet quiet;
    Drawing drawing;
    for (GLenum format : {GL_RGB8, GL_SRGB8_ALPHA8, GL_RGB10_A2, GL_RGB9_E5, GL_R11F_G11F_B10F, GL_RGBA16,
                          GL_RGB16F, GL_RGBA8_SNORM, GL_DEPTH_COMPONENT24, GL_DEPTH32F_STENCIL8}) {
        CAPTURE(format);
        const Texture texture(GL_TEXTURE_2D);
        glTextureStorage2D(texture.name, 1, format, drawing.color.width, drawing.color.height);
        drawing.frame.textures[0] = texture.name;
        CHECK(drawing.refusal() == "no error");
    }
}

TEST_CASE("the executor's own picture is refused as its input") {
    const Quiet quiet;
    Drawing drawing;
    drawing.frame.textures[0] = drawing.executor.run(drawing.frame);
    CHECK_THAT(drawing.refusal(),
               Contains("is the executor's own, which this frame is drawn into; copy it first"));
}

TEST_CASE("numbers that are none are refused with their name") {
    const Quiet quiet;
    Drawing drawing;
    const auto refused = [&](const std::function<void(FrameInputs&)>& spoil, const char* words) {
        const FrameInputs before = drawing.frame;
        spoil(drawing.frame);
        CHECK_THAT(drawing.refusal(), Contains(words));
        drawing.frame = before;
    };
    refused([](FrameInputs& f) { f.camera.vertical_fov = not_a_number; },
            "FrameInputs::camera.vertical_fov is nan; expected");
    refused([](FrameInputs& f) { f.camera.vertical_fov = 180; }, "degrees between 0 and 180");
    refused([](FrameInputs& f) { f.camera.principal_point[1] = INFINITY; },
            "camera.principal_point[1] is inf");
    refused([](FrameInputs& f) { f.camera.depth_scale = not_a_number; }, "camera.depth_scale");
    refused([](FrameInputs& f) { f.camera.near_plane = not_a_number; }, "camera.near_plane");
    refused([](FrameInputs& f) { f.camera.far_plane = not_a_number; }, "camera.far_plane");
    refused([](FrameInputs& f) { f.camera.view_to_world[13] = not_a_number; }, "camera.view_to_world");
    refused(
        [](FrameInputs& f) {
            f.camera.orthographic = true;
            f.camera.vertical_extent = 0;
        },
        "camera.vertical_extent is 0; expected metres above 0");
    refused([](FrameInputs& f) { f.time = not_a_number; }, "FrameInputs::time is nan");
    CHECK(drawing.refusal() == "no error");
}

TEST_CASE("a refused frame leaves the picture of the one before") {
    const Quiet quiet;
    Drawing drawing;
    drawing.executor.run(drawing.frame);
    const Image before = drawing.executor.read_picture();
    drawing.frame.textures[0] = 0;
    CHECK(drawing.refusal() != "no error");
    CHECK(same_bits(before, drawing.executor.read_picture()));
}

TEST_CASE("the picture goes into the host's framebuffer and rectangle, and nowhere else") {
    const Quiet quiet;
    Drawing drawing;
    const postfx::Output kind = GENERATE(postfx::Output::linear, postfx::Output::display);
    drawing.executor.prepare(Planner().plan(chain_of({"tint"}), facts_of(drawing.color), {.output = kind}));
    drawing.executor.run(drawing.frame);
    const Image picture = drawing.executor.read_picture();

    constexpr int side = 100, left = 7, bottom = 11;
    const gl::Texture target(side, side, Format::rgba32f);
    const gl::Framebuffer framebuffer = gl::make_framebuffer({target.name()});
    const float outside[] = {-1, -2, -3, -4};
    glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, 0, outside);
    drawing.executor.run(drawing.frame,
                         OutputTarget{framebuffer.name(), left, bottom, picture.width, picture.height});
    const Image shown = gl::read_texture(target.name(), side, side, Format::rgba32f);
    std::size_t wrong = 0;
    for (int y = 0; y < side; ++y) {
        for (int x = 0; x < side; ++x) {
            const bool within =
                x >= left && y >= bottom && x < left + picture.width && y < bottom + picture.height;
            const float* expected = within ? picture.pixel(x - left, y - bottom) : outside;
            wrong += !std::equal(expected, expected + 3, shown.pixel(x, y));
        }
    }
    CHECK(wrong == 0);
    CHECK(same_bits(picture, drawing.executor.read_picture()));
}

TEST_CASE("codes reach a framebuffer that calls itself sRGB as they are") {
    const Quiet quiet;
    Drawing drawing;
    drawing.executor.prepare(
        Planner().plan(chain_of({"tint"}), facts_of(drawing.color), {.output = postfx::Output::display}));
    const Texture target(GL_TEXTURE_2D);
    const int width = drawing.color.width, height = drawing.color.height;
    glTextureStorage2D(target.name, 1, GL_SRGB8_ALPHA8, width, height);
    const gl::Framebuffer framebuffer = gl::make_framebuffer({target.name});
    glEnable(GL_FRAMEBUFFER_SRGB);
    drawing.executor.run(drawing.frame, OutputTarget{framebuffer.name(), 0, 0, width, height});
    CHECK(glIsEnabled(GL_FRAMEBUFFER_SRGB));
    glDisable(GL_FRAMEBUFFER_SRGB);
    const std::uint32_t picture = drawing.executor.run(drawing.frame);
    CHECK(gl::read_texture_codes(target.name, width, height, 3)
          == gl::read_texture_codes(picture, width, height, 3));
}

TEST_CASE("framebuffers that can't be drawn to are refused") {
    const Quiet quiet;
    Drawing drawing;
    const gl::Texture texture(8, 8, Format::rgba8);
    const gl::Framebuffer good = gl::make_framebuffer({texture.name()});
    CHECK_THROWS_WITH(drawing.executor.run(drawing.frame, OutputTarget{good.name(), 0, 0, 0, 8}),
                      Contains("a rectangle of 0x8 has no pixels"));
    CHECK_THROWS_WITH(drawing.executor.run(drawing.frame, OutputTarget{987654, 0, 0, 8, 8}),
                      "output framebuffer 987654: there is no framebuffer of that name in this context");
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    CHECK_THROWS_WITH(drawing.executor.run(drawing.frame, OutputTarget{name, 0, 0, 8, 8}),
                      Contains("it is not complete"));
    gl::take_debug_messages(); // the driver says so too
    const Texture integers(GL_TEXTURE_2D);
    glTextureStorage2D(integers.name, 1, GL_RGBA8UI, 8, 8);
    glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT0, integers.name, 0);
    CHECK_THROWS_WITH(drawing.executor.run(drawing.frame, OutputTarget{name, 0, 0, 8, 8}),
                      Contains("it holds integers"));
    glDeleteFramebuffers(1, &name);
    CHECK_THROWS_WITH(drawing.executor.run(drawing.frame, OutputTarget{0, 0, 0, 8, 8}),
                      "output framebuffer 0: the context has no window");
}

// Last, since no context is current afterwards.
TEST_CASE("another context, or none, is refused, and its objects are left alone") {
    const auto executor = std::make_unique<Executor>();
    const Image color = test_picture();
    const Inputs inputs(color);
    const Plan plan = Planner().plan(chain_of({"tint"}), facts_of(color), linear_output());
    executor->prepare(plan);
    const FrameInputs frame = inputs.of(plan);
    executor->run(frame);
    const auto refused = [&](Executor& refusing) {
        CHECK_THROWS_WITH(refusing.run(frame), Contains("another OpenGL context is current"));
        CHECK_THROWS_WITH(refusing.prepare(plan), Contains("another OpenGL context is current"));
        CHECK_THROWS_WITH(refusing.read_picture(), Contains("another OpenGL context is current"));
        CHECK_THROWS_WITH(refusing.report(), Contains("another OpenGL context is current"));
    };
    auto moved = std::make_unique<Executor>(std::move(*executor));
    {
        const gl::HeadlessContext other;
        // As many names as the executor has, which would be deleted with it.
        std::vector<gl::Texture> textures;
        std::vector<gl::Buffer> buffers;
        for (int i = 0; i < 20; ++i) {
            textures.emplace_back(4, 4, Format::rgba8);
            buffers.push_back(gl::make_buffer(4, nullptr));
        }
        refused(*moved);
        moved.reset();
        for (int i = 0; i < 20; ++i) {
            CHECK(glIsTexture(textures[static_cast<std::size_t>(i)].name()));
            CHECK(glIsBuffer(buffers[static_cast<std::size_t>(i)].name()));
        }
    }
    CHECK_THROWS_WITH(Executor(), Contains("no OpenGL context is current on this thread"));
}
