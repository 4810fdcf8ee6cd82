#include <execute/tile_passes.hpp>

#include <array>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <utility>

namespace postfx {
namespace {

/// Lists the tiles that are drawn and those that are not. A thread looks at a block of 8x8 tiles. Tiles that fill a
/// block of 8x8 or 4x4 become one rectangle: where the two triangles of a rectangle meet, pixels are shaded twice over,
/// and the larger it is, the smaller their share. For the same reason 4x4 tiles of which more than half are to be drawn
/// are all drawn.
constexpr std::string_view list_shader = R"(#version 450 core
// In any order: what is drawn does not depend on it.
layout(local_size_x = 64) in;
layout(binding = 0) uniform sampler2D u_mask;
struct List {
    uint vertices, instances, first_vertex, first_instance; // of an indirect draw
    uint tiles;                                             // for the report
    uint unused[3];
};
layout(std430, binding = 6) buffer Lists { List b_lists[2]; }; // to be drawn, not to be drawn
layout(std430, binding = 7) writeonly buffer Rectangles { uvec2 b_rectangles[]; }; // x and y in 16 bits each; side

void add(uint list, ivec2 tile, uint side, uint tiles) {
    uint first = list * (uint(b_rectangles.length()) / 2u);
    b_rectangles[first + atomicAdd(b_lists[list].vertices, 6u) / 6u] = uvec2(uint(tile.x) | uint(tile.y) << 16, side);
    atomicAdd(b_lists[list].tiles, tiles);
}

void main() {
    ivec2 size = textureSize(u_mask, 0), blocks = (size + 7) / 8;
    ivec2 block = ivec2(gl_GlobalInvocationID.x % uint(blocks.x), gl_GlobalInvocationID.x / uint(blocks.x));
    if (block.y >= blocks.y) return;
    // Bits of 4x4 tiles each. One loop that is too long to be written out: nested ones are, and compile for longer than
    // most effects.
    uvec4 present = uvec4(0u), drawn = uvec4(0u);
    for (int i = 0; i < 64; ++i) {
        int quarter = i >> 4;
        ivec2 tile = 8 * block + 4 * ivec2(quarter & 1, quarter >> 1) + ivec2(i & 3, i >> 2 & 3);
        if (any(greaterThanEqual(tile, size))) continue;
        present[quarter] |= 1u << (i & 15);
        if (texelFetch(u_mask, tile, 0).r != 0.0) drawn[quarter] |= 1u << (i & 15);
    }
    int drawn_count = 0, count = 0;
    for (int quarter = 0; quarter < 4; ++quarter) {
        if (2 * bitCount(drawn[quarter]) > bitCount(present[quarter])) drawn[quarter] = present[quarter];
        drawn_count += bitCount(drawn[quarter]);
        count += bitCount(present[quarter]);
    }
    if (drawn_count == 0 || drawn_count == count) {
        add(drawn_count == 0 ? 1u : 0u, 8 * block, 8u, uint(count));
        return;
    }
    for (int i = 0; i < 8; ++i) {
        uint list = uint(i & 1);
        int quarter = i >> 1;
        ivec2 corner = 8 * block + 4 * ivec2(quarter & 1, quarter >> 1);
        uint bits = list == 0u ? drawn[quarter] : present[quarter] & ~drawn[quarter];
        bool whole = bits == present[quarter];
        for (uint left = whole ? min(bits, 1u) : bits; left != 0u; left &= left - 1u) {
            int first = findLSB(left);
            add(list, corner + ivec2(first & 3, first >> 2), whole ? 4u : 1u, whole ? uint(bitCount(bits)) : 1u);
        }
    }
}
)";

constexpr std::string_view clear_shader = R"(#version 450 core
layout(location = 0) out vec4 o_0;
layout(location = 1) out vec4 o_1;
layout(location = 2) out vec4 o_2;
layout(location = 3) out vec4 o_3;
layout(location = 4) out vec4 o_4;
layout(location = 5) out vec4 o_5;
layout(location = 6) out vec4 o_6;
layout(location = 7) out vec4 o_7;
void main() {
    o_0 = o_1 = o_2 = o_3 = o_4 = o_5 = o_6 = o_7 = vec4(0.0);
}
)";

constexpr int group_size = 64, block_side = 8;
constexpr std::size_t rectangle_bytes = 2 * sizeof(std::uint32_t);

struct ListHead {
    std::uint32_t vertices = 0, instances = 1, first_vertex = 0, first_instance = 0;
    std::uint32_t tiles = 0;
    std::uint32_t unused[3] = {};
};
/// Drawn, not drawn.
using ListHeads = std::array<ListHead, 2>;

/// Offsets at which any GL lets a storage buffer be bound.
constexpr std::size_t heads_stride = 256;

constexpr GLint tile_size_location = 0, first_location = 1;
/// Beyond those of a pass's inputs.
constexpr GLuint rectangles_unit = 16;

ProgramSource source_of(std::string_view text, ProgramKind kind) {
    ProgramSource source;
    source.text = text;
    source.kind = kind;
    source.key = std::hash<std::string>{}(source.text);
    return source;
}

} // namespace

// Six vertices for each rectangle, not an instance: software rasterisers set up each instance as a draw of its own.
const char* const tile_vertex_text = R"(#version 450 core
layout(binding = 16) uniform usamplerBuffer u_rectangles; // x and y in 16 bits each, side; all in tiles
layout(location = 0) uniform vec2 u_tile_size;            // of the target's
layout(location = 1) uniform int u_first;
void main() {
    uvec2 rectangle = texelFetch(u_rectangles, u_first + gl_VertexID / 6).rg;
    vec2 corner = vec2(0x16 >> gl_VertexID % 6 & 1, 0x34 >> gl_VertexID % 6 & 1);
    vec2 first = vec2(rectangle.x & 0xffffu, rectangle.x >> 16);
    gl_Position = vec4((first + corner * float(rectangle.y)) * u_tile_size * 2.0 - 1.0, 0.0, 1.0);
}
)";

const std::vector<ProgramSource>& tile_programs() {
    static const std::vector<ProgramSource> sources = {source_of(list_shader, ProgramKind::compute),
                                                       source_of(clear_shader, ProgramKind::tiles)};
    return sources;
}

TilePasses::TilePasses(const Plan& plan, ProgramCache& programs)
    : list_program_(programs.get(tile_programs()[0], "tile list")),
      clear_program_(programs.get(tile_programs()[1], "tile clear")), lists_(plan.passes.size()) {
    for (std::size_t i = 0; i < plan.passes.size(); ++i) {
        const Pass& pass = plan.passes[i];
        if (pass.where.kind == ImageRef::Kind::none) continue;
        const std::size_t tiles =
            static_cast<std::size_t>(pass.tiles_across) * static_cast<std::size_t>(pass.tiles_down);
        gl::Buffer rectangles = gl::make_buffer(2 * tiles * rectangle_bytes, nullptr);
        gl::BufferTexture view = gl::make_buffer_texture(rectangles, GL_RG32UI);
        lists_[i] = Lists{std::move(rectangles), std::move(view), static_cast<GLint>(tiles), groups(pass),
                          static_cast<GLintptr>(fresh_heads_.size())};
        const ListHeads heads;
        fresh_heads_.resize(fresh_heads_.size() + heads_stride);
        std::memcpy(fresh_heads_.data() + lists_[i]->heads, &heads, sizeof(heads));
    }
    heads_ = gl::make_buffer(fresh_heads_.size(), fresh_heads_.data());
}

void TilePasses::begin_frame() const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glNamedBufferSubData(heads_.name(), 0, static_cast<GLsizeiptr>(fresh_heads_.size()), fresh_heads_.data());
}

GLuint TilePasses::groups(const Pass& pass) {
    const int blocks = ((pass.tiles_across + block_side - 1) / block_side)
                       * ((pass.tiles_down + block_side - 1) / block_side);
    return static_cast<GLuint>((blocks + group_size - 1) / group_size);
}

void TilePasses::list(std::size_t pass_index, GLuint mask, std::optional<GLintptr> command) const {
    const Lists& lists = *lists_[pass_index];
    glUseProgram(list_program_);
    glBindTextureUnit(0, mask);
    glBindSampler(0, 0);
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 6, heads_.name(), lists.heads, sizeof(ListHeads));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 7, lists.rectangles.name());
    if (command) {
        glDispatchComputeIndirect(*command);
    } else {
        glDispatchCompute(lists.groups, 1, 1);
    }
    glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
}

void TilePasses::draw(const Pass& pass, std::size_t pass_index, GLuint program) const {
    glBindTextureUnit(rectangles_unit, lists_[pass_index]->view.name());
    glBindBuffer(GL_DRAW_INDIRECT_BUFFER, heads_.name());
    draw_list(pass, *lists_[pass_index], 1, clear_program_);
    draw_list(pass, *lists_[pass_index], 0, program);
}

void TilePasses::draw_list(const Pass& pass, const Lists& lists, GLint list, GLuint program) const {
    glUseProgram(program);
    glUniform2f(tile_size_location, static_cast<float>(pass.tile_side) / static_cast<float>(pass.width),
                static_cast<float>(pass.tile_side) / static_cast<float>(pass.height));
    glUniform1i(first_location, list * lists.second_list);
    const GLintptr command = lists.heads + list * static_cast<GLintptr>(sizeof(ListHead));
    glDrawArraysIndirect(GL_TRIANGLES, reinterpret_cast<const void*>(command));
}

std::vector<std::optional<int>> TilePasses::read() const {
    std::vector<std::byte> bytes(fresh_heads_.size());
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(heads_.name(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    std::vector<std::optional<int>> drawn(lists_.size());
    for (std::size_t i = 0; i < lists_.size(); ++i) {
        if (!lists_[i]) continue;
        ListHeads heads;
        std::memcpy(&heads, bytes.data() + lists_[i]->heads, sizeof(heads));
        drawn[i] = static_cast<int>(heads.front().tiles);
    }
    return drawn;
}

} // namespace postfx
