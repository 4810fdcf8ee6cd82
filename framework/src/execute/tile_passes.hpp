// Passes that are drawn only in the tiles of a mask: the GPU lists the tiles and draws as many rectangles.
#pragma once

#include <execute/program_cache.hpp>
#include <gl/objects.hpp>

#include <postfx/plan.hpp>

#include <cstddef>
#include <optional>
#include <vector>

namespace postfx {

/// How a tile becomes a rectangle of the target: vertex shader of every program that is drawn in tiles.
extern const char* const tile_vertex_text;

/// The programs that every plan with tiles needs besides those of its passes.
const std::vector<ProgramSource>& tile_programs();

/// The tile lists of one plan. [GL thread]
class TilePasses {
public:
    TilePasses(const Plan& plan, ProgramCache& programs);

    /// Forget the lists of the frame before.
    void begin_frame() const;
    /// List the tiles of `mask` that the pass is drawn in. `command`: where in the bound dispatch buffer the number
    /// of groups is, if it depends on a decision.
    void list(std::size_t pass_index, GLuint mask, std::optional<GLintptr> command) const;
    /// Draw them with the pass's program, into the current framebuffer; the outputs become 0 elsewhere.
    void draw(const Pass& pass, std::size_t pass_index, GLuint program) const;

    /// Groups that list the tiles of a mask.
    static GLuint groups(const Pass& pass);

    /// Tiles drawn in the last frame, for each pass of the plan; nothing for those that are drawn everywhere. Waits for
    /// the GPU.
    std::vector<std::optional<int>> read() const;

private:
    struct Lists {
        gl::Buffer rectangles; ///< uvec2 each: of the tiles that are drawn, then of the others
        gl::BufferTexture view;
        GLint second_list = 0; ///< its first rectangle
        GLuint groups = 0;     ///< that make them
        GLintptr heads = 0;    ///< in heads_
    };
    void draw_list(const Pass& pass, const Lists& lists, GLint list, GLuint program) const;

    GLuint list_program_, clear_program_;
    gl::Buffer heads_; ///< draw commands and counts of all lists
    std::vector<std::byte> fresh_heads_;
    std::vector<std::optional<Lists>> lists_; ///< per pass
};

} // namespace postfx
