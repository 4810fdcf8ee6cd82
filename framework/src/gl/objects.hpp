// Owners of GL objects, direct state access throughout. Move-only; an empty one has name 0. [GL thread]
#pragma once

#include <postfx/format.hpp>
#include <postfx/image.hpp>

#include <postfx_glad/gl.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace postfx::gl {

/// While one that was made with `true` lives, handles that die on this thread leave their GL objects alone: their
/// context is not current, and in another one their names are somebody else's.
class LeaveObjects {
public:
    explicit LeaveObjects(bool leave) : before_(std::exchange(active_, leave)) {}
    ~LeaveObjects() { active_ = before_; }
    LeaveObjects(const LeaveObjects&) = delete;
    LeaveObjects& operator=(const LeaveObjects&) = delete;

    static bool active() { return active_; }

private:
    static thread_local bool active_;
    bool before_;
};

/// Owns one GL name; `destroy` is the matching glDelete.
template<void (*destroy)(GLuint)>
class Handle {
public:
    Handle() = default;
    explicit Handle(GLuint name) : name_(name) {}
    Handle(Handle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    ~Handle() {
        if (name_ && !LeaveObjects::active()) destroy(name_);
    }
    GLuint name() const { return name_; }
    explicit operator bool() const { return name_ != 0; }

private:
    GLuint name_ = 0;
};

void destroy_texture(GLuint name);
void destroy_framebuffer(GLuint name);
void destroy_buffer(GLuint name);
void destroy_vertex_array(GLuint name);
void destroy_program(GLuint name);
void destroy_query(GLuint name);
void destroy_sampler(GLuint name);

using Framebuffer = Handle<destroy_framebuffer>;
using Buffer = Handle<destroy_buffer>;
using VertexArray = Handle<destroy_vertex_array>;
using Program = Handle<destroy_program>;
using Query = Handle<destroy_query>;
using Sampler = Handle<destroy_sampler>;
using BufferTexture = Handle<destroy_texture>;

GLenum internal_format(Format format);

/// A 2D texture with immutable storage, clamped at its edges, nearest filtering (samplers override it).
class Texture : public Handle<destroy_texture> {
public:
    Texture() = default;
    /// glTextureStorage2D. `levels` mip levels. Throws Error on a size that the device can't have.
    Texture(int width, int height, Format format, int levels = 1);

    int width() const { return width_; }
    int height() const { return height_; }
    Format format() const { return format_; }

    /// Upload level 0. Channels that the image lacks become 0, alpha 1. Throws Error on another size or too
    /// many channels.
    void upload(const Image& image);

private:
    int width_ = 0, height_ = 0;
    Format format_ = Format::rgba8;
};

/// Level 0 of any 2D texture as floats, with the channels of its format. Waits for the GPU. NaN payloads
/// survive in 32-bit formats.
Image read_texture(GLuint texture, int width, int height, Format format);
/// Level 0 of an 8-bit texture as codes, bottom row first.
std::vector<unsigned char> read_texture_codes(GLuint texture, int width, int height, int channels);

/// glCreateFramebuffers with these colour attachments and, if not 0, depth; checked for completeness.
Framebuffer make_framebuffer(const std::vector<GLuint>& colors, GLuint depth = 0);
/// `bytes` is at least 1; `data` may be null.
Buffer make_buffer(std::size_t bytes, const void* data, GLbitfield flags = GL_DYNAMIC_STORAGE_BIT);
/// A view of a buffer for texelFetch; `format` is a GL internal format.
BufferTexture make_buffer_texture(const Buffer& buffer, GLenum format);
VertexArray make_vertex_array();
/// Clamp to edge; linear or nearest, no mips.
Sampler make_sampler(bool linear);

/// Compile and link; the binary can be retrieved. Throws Error with place.file and line from the first error
/// in the driver's log, found through the sources' #line directives and `files` (by source-string number);
/// `what` names the program in the message; may be empty.
Program make_program(std::string_view vertex, std::string_view fragment, const std::string& what,
                     const std::vector<std::string>& files = {});
/// The same of one compute shader.
Program make_compute_program(std::string_view compute, const std::string& what,
                             const std::vector<std::string>& files = {});

} // namespace postfx::gl
