#include <gl/objects.hpp>
#include <gl/pass_state.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <array>
#include <cassert>
#include <string>

namespace postfx::gl {
namespace {

struct GlFormat {
    Format format;
    GLenum internal; ///< as stored
    GLenum channels; ///< as transferred
};

constexpr std::array<GlFormat, 11> formats = {{
    {Format::r8, GL_R8, GL_RED},
    {Format::rg8, GL_RG8, GL_RG},
    {Format::rgba8, GL_RGBA8, GL_RGBA},
    {Format::r16f, GL_R16F, GL_RED},
    {Format::rg16f, GL_RG16F, GL_RG},
    {Format::rgba16f, GL_RGBA16F, GL_RGBA},
    {Format::r32f, GL_R32F, GL_RED},
    {Format::rg32f, GL_RG32F, GL_RG},
    {Format::rgba32f, GL_RGBA32F, GL_RGBA},
    {Format::r11g11b10f, GL_R11F_G11F_B10F, GL_RGB},
    {Format::depth32f, GL_DEPTH_COMPONENT32F, GL_DEPTH_COMPONENT},
}};

constexpr bool in_enum_order() {
    for (std::size_t i = 0; i < formats.size(); ++i) {
        if (formats[i].format != static_cast<Format>(i)) return false;
    }
    return true;
}
static_assert(in_enum_order(), "formats is indexed by Format");

const GlFormat& gl_format(Format format) {
    return formats[static_cast<std::size_t>(format)];
}

GLenum color_channels(int count) {
    assert(count >= 1 && count <= 4);
    constexpr std::array<GLenum, 4> words = {GL_RED, GL_RG, GL_RGB, GL_RGBA};
    return words[static_cast<std::size_t>(count - 1)];
}

void check_size(int width, int height) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &largest);
    if (width >= 1 && height >= 1 && width <= largest && height <= largest) return;
    throw Error(fmt::format("a texture of {}x{} pixels; this device has at most {}x{}", width, height,
                            largest, largest));
}

GLuint create_texture() {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    return name;
}

std::string_view status_name(GLenum status) {
    switch (status) {
    case GL_FRAMEBUFFER_INCOMPLETE_ATTACHMENT:
        return "an attachment can't be drawn to";
    case GL_FRAMEBUFFER_INCOMPLETE_MISSING_ATTACHMENT:
        return "it has no attachment";
    case GL_FRAMEBUFFER_UNSUPPORTED:
        return "this combination of formats is not supported";
    default:
        return "its attachments don't go together";
    }
}

} // namespace

thread_local bool LeaveObjects::active_ = false;

void destroy_texture(GLuint name) {
    glDeleteTextures(1, &name);
}
void destroy_framebuffer(GLuint name) {
    glDeleteFramebuffers(1, &name);
}
void destroy_buffer(GLuint name) {
    glDeleteBuffers(1, &name);
}
void destroy_vertex_array(GLuint name) {
    glDeleteVertexArrays(1, &name);
}
void destroy_query(GLuint name) {
    glDeleteQueries(1, &name);
}
void destroy_sampler(GLuint name) {
    glDeleteSamplers(1, &name);
}

GLenum internal_format(Format format) {
    return gl_format(format).internal;
}

Texture::Texture(int width, int height, Format format, int levels)
    : Handle(create_texture()), width_(width), height_(height), format_(format) {
    check_size(width, height);
    glTextureStorage2D(name(), levels, internal_format(format), width, height);
    if (glGetError() == GL_OUT_OF_MEMORY) {
        throw Error(
            fmt::format("no memory for a {} texture of {}x{}", format_info(format).name, width, height));
    }
    glTextureParameteri(name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTextureParameteri(name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glTextureParameteri(name(), GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTextureParameteri(name(), GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_NEAREST_MIPMAP_NEAREST : GL_NEAREST);
}

void Texture::upload(const Image& image) {
    const FormatInfo& info = format_info(format_);
    if (image.width != width_ || image.height != height_ || image.channels < 1
        || image.channels > info.channels) {
        throw Error(fmt::format("an image of {}x{} with {} channels does not fit a {} texture of {}x{}",
                                image.width, image.height, image.channels, info.name, width_, height_));
    }
    const GLenum channels =
        format_ == Format::depth32f ? GLenum{GL_DEPTH_COMPONENT} : color_channels(image.channels);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(name(), 0, 0, 0, width_, height_, channels, GL_FLOAT, image.values.data());
}

Image read_texture(GLuint texture, int width, int height, Format format) {
    Image image(width, height, format_info(format).channels);
    const TightPacking packing;
    glGetTextureImage(texture, 0, gl_format(format).channels, GL_FLOAT,
                      static_cast<GLsizei>(image.values.size() * sizeof(float)), image.values.data());
    return image;
}

std::vector<unsigned char> read_texture_codes(GLuint texture, int width, int height, int channels) {
    std::vector<unsigned char> codes(static_cast<std::size_t>(width) * static_cast<std::size_t>(height)
                                     * static_cast<std::size_t>(channels));
    const TightPacking packing;
    glGetTextureImage(texture, 0, color_channels(channels), GL_UNSIGNED_BYTE,
                      static_cast<GLsizei>(codes.size()), codes.data());
    return codes;
}

Framebuffer make_framebuffer(const std::vector<GLuint>& colors, GLuint depth) {
    GLuint name = 0;
    glCreateFramebuffers(1, &name);
    Framebuffer framebuffer(name);
    std::vector<GLenum> draw_buffers;
    for (GLuint color : colors) {
        const GLenum attachment = GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(draw_buffers.size());
        glNamedFramebufferTexture(name, attachment, color, 0);
        draw_buffers.push_back(attachment);
    }
    glNamedFramebufferDrawBuffers(name, static_cast<GLsizei>(draw_buffers.size()), draw_buffers.data());
    if (depth) glNamedFramebufferTexture(name, GL_DEPTH_ATTACHMENT, depth, 0);
    const GLenum status = glCheckNamedFramebufferStatus(name, GL_DRAW_FRAMEBUFFER);
    if (status != GL_FRAMEBUFFER_COMPLETE) {
        throw Error(fmt::format("a framebuffer of {} colours{} can't be used: {} (0x{:x})", colors.size(),
                                depth ? " and depth" : "", status_name(status), status));
    }
    return framebuffer;
}

Buffer make_buffer(std::size_t bytes, const void* data, GLbitfield flags) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), data, flags);
    return Buffer(name);
}

BufferTexture make_buffer_texture(const Buffer& buffer, GLenum format) {
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_BUFFER, 1, &name);
    BufferTexture texture(name);
    glTextureBuffer(name, format, buffer.name());
    return texture;
}

VertexArray make_vertex_array() {
    GLuint name = 0;
    glCreateVertexArrays(1, &name);
    return VertexArray(name);
}

Sampler make_sampler(bool linear) {
    GLuint name = 0;
    glCreateSamplers(1, &name);
    const GLint filter = linear ? GL_LINEAR : GL_NEAREST;
    glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER, filter);
    glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, filter);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    return Sampler(name);
}

} // namespace postfx::gl
