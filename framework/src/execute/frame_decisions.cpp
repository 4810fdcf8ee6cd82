#include <execute/frame_decisions.hpp>

#include <execute/tile_passes.hpp>

#include <plan/assemble.hpp>

#include <algorithm>
#include <cstring>
#include <span>

namespace postfx {
namespace {

struct CensusBits {
    std::uint32_t lowest[3] = {~0u, ~0u, ~0u}, highest[3] = {0, 0, 0};
    std::uint32_t spoiled = 0, skies = 0;
};
static_assert(sizeof(CensusBits) == 32);

using Command = std::array<std::uint32_t, 4>; // DrawArraysIndirectCommand, or three group counts

struct Conditional {
    Command command;
    std::uint32_t first_term, term_count;
    std::uint32_t unused[2];
};
static_assert(sizeof(Conditional) == 32);

constexpr std::size_t decisions_head = 8; // bytes before the compared numbers

std::array<std::uint32_t, 2> census_groups(const Pass& pass) {
    return {static_cast<std::uint32_t>((pass.width + census_group_width - 1) / census_group_width),
            static_cast<std::uint32_t>((pass.height + census_group_height - 1) / census_group_height)};
}

Command command_of(const Pass& pass) {
    if (pass.where.kind != ImageRef::Kind::none) return {TilePasses::groups(pass), 1, 1, 0};
    if (pass.kind == PassKind::draw) return {3, 1, 0, 0};
    const auto [x, y] = census_groups(pass);
    return {x, y, 1, 0};
}

template<class Element>
std::vector<std::byte> bytes_of(const std::vector<Element>& elements) {
    std::vector<std::byte> bytes(elements.size() * sizeof(Element));
    if (!bytes.empty()) std::memcpy(bytes.data(), elements.data(), bytes.size());
    return bytes;
}

/// GL has no buffers of no bytes.
gl::Buffer buffer_of(const std::vector<std::byte>& bytes) {
    return gl::make_buffer(std::max<std::size_t>(bytes.size(), 16), nullptr);
}

void write(const gl::Buffer& buffer, const std::vector<std::byte>& bytes) {
    glNamedBufferSubData(buffer.name(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
}

} // namespace

FrameDecisions::FrameDecisions(const Plan& plan)
    : fresh_censuses_(bytes_of(std::vector<CensusBits>(static_cast<std::size_t>(plan.censuses)))),
      fresh_decisions_(decisions_head + plan.decisions.size() * 2 * sizeof(float)),
      command_of_pass_(plan.passes.size(), -1) {
    std::vector<Conditional> conditionals;
    std::vector<Term> terms;
    for (std::size_t i = 0; i < plan.passes.size(); ++i) {
        const Condition& condition = plan.passes[i].condition;
        if (condition.empty()) continue;
        command_of_pass_[i] = static_cast<int>(conditionals.size());
        conditionals.push_back({command_of(plan.passes[i]),
                                static_cast<std::uint32_t>(terms.size()),
                                static_cast<std::uint32_t>(condition.size()),
                                {}});
        terms.insert(terms.end(), condition.begin(), condition.end());
    }
    censuses_ = buffer_of(fresh_censuses_);
    decisions_ = buffer_of(fresh_decisions_);
    const std::vector<std::byte> conditional_bytes = bytes_of(conditionals), term_bytes = bytes_of(terms);
    conditionals_ = buffer_of(conditional_bytes);
    terms_ = buffer_of(term_bytes);
    write(conditionals_, conditional_bytes);
    write(terms_, term_bytes);
    commands_ = gl::make_buffer(std::max<std::size_t>(1, conditionals.size()) * sizeof(Command), nullptr);
}

void FrameDecisions::begin_frame() const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    write(censuses_, fresh_censuses_);
    write(decisions_, fresh_decisions_);
    const gl::Buffer* const buffers[] = {&censuses_, &decisions_, &conditionals_, &terms_, &commands_};
    for (GLuint i = 0; i < std::size(buffers); ++i)
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1 + i, buffers[i]->name());
    glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, commands_.name());
}

std::optional<GLintptr> FrameDecisions::command(std::size_t pass_index) const {
    const int command = command_of_pass_[pass_index];
    if (command < 0) return std::nullopt;
    return static_cast<GLintptr>(command * static_cast<std::ptrdiff_t>(sizeof(Command)));
}

void FrameDecisions::execute(const Pass& pass, std::size_t pass_index) const {
    const std::optional<GLintptr> where = command(pass_index);
    switch (pass.kind) {
    case PassKind::draw:
        if (where) {
            glBindBuffer(GL_DRAW_INDIRECT_BUFFER, commands_.name());
            glDrawArraysIndirect(GL_TRIANGLES, reinterpret_cast<const void*>(*where));
        } else {
            glDrawArrays(GL_TRIANGLES, 0, 3);
        }
        break;
    case PassKind::census: {
        glUniform1ui(0, static_cast<GLuint>(pass.slot));
        const auto [x, y] = census_groups(pass);
        if (where) {
            glDispatchComputeIndirect(*where);
        } else {
            glDispatchCompute(x, y, 1);
        }
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
        break;
    }
    case PassKind::decide:
        glDispatchCompute(1, 1, 1);
        glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
        break;
    }
}

FrameOutcome FrameDecisions::read() const {
    std::vector<std::byte> bytes(fresh_decisions_.size());
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    glGetNamedBufferSubData(decisions_.name(), 0, static_cast<GLsizeiptr>(bytes.size()), bytes.data());
    FrameOutcome outcome;
    std::memcpy(&outcome.live, bytes.data(), sizeof(outcome.live));
    outcome.compared.resize((bytes.size() - decisions_head) / (2 * sizeof(float)));
    std::memcpy(outcome.compared.data(), bytes.data() + decisions_head, bytes.size() - decisions_head);
    return outcome;
}

} // namespace postfx
