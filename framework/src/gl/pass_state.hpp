// The context's state around full-screen passes and dispatches: what they rely on, and what the host had. [GL thread]
#pragma once

#include <postfx_glad/gl.h>

#include <array>
#include <cstddef>

namespace postfx::gl {

/// The fixed state that full-screen passes rely on, whatever the host drew before. Without effect on transform feedback,
/// which must not be running.
void set_pass_state();

/// Which binding points will be bound anew.
struct StateUse {
    std::size_t texture_units = 0;    ///< 2D textures and samplers of units 0, 1, ...; at most 16
    bool buffer_texture_unit = false; ///< a buffer texture in unit 16 too
    std::size_t storage_buffers = 0;  ///< of binding points 0, 1, ...; at most 8
};

/// Everything that set_pass_state() and passes change, as it was when this was made: put back when it dies. Transform
/// feedback that is running pauses meanwhile. Allocates no memory.
class SavedState {
public:
    explicit SavedState(const StateUse& use);
    ~SavedState();
    SavedState(const SavedState&) = delete;
    SavedState& operator=(const SavedState&) = delete;

    static constexpr std::size_t most_texture_units = 16, most_storage_buffers = 8;
    static constexpr GLuint buffer_texture_unit = 16;

private:
    static constexpr std::size_t switch_count = 23, draw_buffers = 8, uniform_buffers = 2;

    struct Raster {
        std::array<GLboolean, switch_count> switches;
        std::array<GLboolean, draw_buffers> blends;
        std::array<std::array<GLboolean, 4>, draw_buffers> color_masks;
        GLboolean scissor;
        GLint polygon_mode, clip_origin, clip_depth;
        std::array<GLfloat, 4> viewport;
    };
    struct Bindings {
        GLint draw_framebuffer, read_framebuffer, program, vertex_array;
        GLint draw_indirect, dispatch_indirect, uniform, storage;
        GLint active_texture;
    };
    struct Unit {
        GLint texture = 0, sampler = 0;
    };
    struct IndexedBuffer {
        GLint name = 0;
        GLint64 start = 0, size = 0;
    };
    static IndexedBuffer indexed_buffer(GLenum binding, GLenum start, GLenum size, GLuint index);
    static void bind(GLenum target, GLuint index, const IndexedBuffer& buffer);
    void save_raster();
    void save_bindings();
    void restore_raster() const;
    void restore_bindings() const;

    StateUse use_;
    Raster raster_;
    Bindings bindings_;
    std::array<Unit, most_texture_units> units_;
    Unit buffer_texture_;
    std::array<IndexedBuffer, uniform_buffers> uniform_buffers_;
    std::array<IndexedBuffer, most_storage_buffers> storage_buffers_;
    bool paused_feedback_ = false;
};

/// Is transform feedback running, and not paused? Then no program can be bound.
bool transform_feedback_runs();

/// How pixels that are read are laid out in memory: as glGetTextureImage lays them out without any setting, rows without
/// padding; what the host had is put back when this dies.
class TightPacking {
public:
    TightPacking();
    ~TightPacking();
    TightPacking(const TightPacking&) = delete;
    TightPacking& operator=(const TightPacking&) = delete;

private:
    static constexpr std::size_t setting_count = 8;
    std::array<GLint, setting_count> settings_;
    GLint buffer_ = 0, clamp_ = 0;
};

} // namespace postfx::gl
