#include <execute/device_limits.hpp>
#include <execute/frame_checks.hpp>
#include <execute/frame_decisions.hpp>
#include <execute/framebuffer_output.hpp>
#include <execute/nonfinite_watch.hpp>
#include <execute/program_cache.hpp>
#include <execute/tap_counts.hpp>
#include <execute/tile_passes.hpp>
#include <execute/warm_up.hpp>
#include <gl/clock.hpp>
#include <gl/context.hpp>
#include <gl/objects.hpp>
#include <gl/pass_state.hpp>
#include <plan/frame_block.hpp>
#include <report/run.hpp>

#include <postfx/error.hpp>
#include <postfx/executor.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace postfx {
namespace {

FrameBlock block_of(const Plan& plan, const FrameInputs& inputs) {
    FrameBlock block = frame_block(plan.width, plan.height, inputs.camera);
    block.time = static_cast<float>(inputs.time);
    block.frame = inputs.frame;
    block.seed = inputs.seed;
    return block;
}

using TexturePtr = std::shared_ptr<gl::Texture>;

} // namespace

struct Executor::State {
    /// A pass of the current plan with its GL names looked up.
    struct ReadyPass {
        std::string name;
        GLuint program = 0;
        gl::Framebuffer framebuffer;
        gl::Buffer block;
    };
    /// Everything that belongs to one plan.
    struct Ready {
        Plan plan;
        std::vector<TexturePtr> targets; ///< shared with the plan before while that is being replaced
        std::vector<ReadyPass> passes;
        std::optional<FrameDecisions> decisions; ///< if the plan has any
        std::optional<TilePasses> tiles;         ///< likewise
        std::optional<TapCounts> taps;           ///< if programs count them
        ProgramCount programs;
        std::unique_ptr<WarmUp> warm_up; ///< if there is one, until the first run is over
        gl::StateUse state_use;
    };

    explicit State(ExecutorOptions options)
        : context(gl::require_context(options.get_proc_address)), keep_gl_state(options.keep_gl_state),
          programs(std::move(options.program_cache)), vertex_array(gl::make_vertex_array()),
          nearest(gl::make_sampler(false)), linear(gl::make_sampler(true)),
          frame_buffer(gl::make_buffer(sizeof(FrameBlock), nullptr)) {}

    GLuint texture(const Ready& ready, const ImageRef& image,
                   const std::vector<std::uint32_t>& attachments) const {
        return image.kind == ImageRef::Kind::attachment ? attachments[image.index]
                                                        : ready.targets[image.index]->name();
    }

    /// Does the current plan draw into it?
    bool owns(GLuint name) const {
        return std::any_of(current.targets.begin(), current.targets.end(),
                           [&](const TexturePtr& target) { return target->name() == name; });
    }

    /// What all passes of a frame rely on.
    void begin_frame(const FrameBlock& block) const {
        gl::set_pass_state();
        glNamedBufferSubData(frame_buffer.name(), 0, sizeof(block), &block);
        glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_buffer.name());
        glBindVertexArray(vertex_array.name());
        if (current.decisions) current.decisions->begin_frame();
        if (current.tiles) current.tiles->begin_frame();
        if (current.taps) current.taps->begin_frame();
    }

    /// Throws Error where names of GL objects would be somebody else's.
    void expect_context() const {
        if (!context.is_current())
            throw Error(
                "another OpenGL context is current than the one that this executor was made in, or none");
    }

    /// Hold it while drawing: the host's state comes back when it dies, if that is wished.
    std::optional<gl::SavedState> save_gl_state() const {
        if (keep_gl_state) return std::optional<gl::SavedState>(std::in_place, current.state_use);
        if (gl::transform_feedback_runs()) {
            throw Error("transform feedback is running: pause it before run(), or leave "
                        "ExecutorOptions::keep_gl_state on");
        }
        return std::nullopt;
    }

    /// What the host must not meet even where its state is not kept: our samplers in its own draws, and programs and
    /// targets that end with this.
    void end_frame() const {
        if (keep_gl_state) return;
        for (GLuint unit = 0; unit < gl::SavedState::most_texture_units; ++unit)
            glBindSampler(unit, 0);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
        glUseProgram(0);
    }

    void execute(std::size_t index, const std::vector<std::uint32_t>& attachments) const {
        const ReadyPass& ready_pass = current.passes[index];
        const Pass& pass = current.plan.passes[index];
        const gl::DebugGroup group(ready_pass.name.c_str());
        const bool tiled = pass.where.kind != ImageRef::Kind::none;
        if (tiled) {
            current.tiles->list(index, texture(current, pass.where, attachments),
                                current.decisions ? current.decisions->command(index) : std::nullopt);
        }
        if (pass.kind == PassKind::draw) {
            glBindFramebuffer(GL_DRAW_FRAMEBUFFER, ready_pass.framebuffer.name());
            glViewportIndexedf(0, 0, 0, static_cast<float>(pass.width), static_cast<float>(pass.height));
        }
        glUseProgram(ready_pass.program);
        if (ready_pass.block) glBindBufferBase(GL_UNIFORM_BUFFER, 1, ready_pass.block.name());
        if (current.taps) current.taps->bind(index);
        for (std::size_t unit = 0; unit < pass.inputs.size(); ++unit) {
            const PassInput& input = pass.inputs[unit];
            glBindTextureUnit(static_cast<GLuint>(unit), texture(current, input.image, attachments));
            glBindSampler(static_cast<GLuint>(unit), (input.linear ? linear : nearest).name());
        }
        if (tiled) {
            current.tiles->draw(pass, index, ready_pass.program);
        } else if (current.decisions) {
            current.decisions->execute(pass, index);
        } else {
            glDrawArrays(GL_TRIANGLES, 0, 3);
        }
    }

    /// Throws Error for inputs that the current plan can't be drawn with.
    void check(const FrameInputs& inputs) const;
    /// The current plan's passes.
    void draw(const FrameInputs& inputs, Timing timing, Watch watch_for);

    gl::CurrentContext context; ///< first: what follows needs its functions
    bool keep_gl_state;
    ProgramCache programs;
    gl::VertexArray vertex_array;
    gl::Sampler nearest, linear;
    gl::Buffer frame_buffer;
    Ready current;
    std::vector<PassTime> profile; ///< of the last profiled run
    std::optional<gl::TimestampRing> ring;
    std::optional<gl::ClockCheck> clock;
    std::optional<NonfiniteWatch> watch;
    std::optional<FramebufferOutput> output; ///< from the first run on that wants it
    Timing last_timing = Timing::off;
    Watch last_watch = Watch::off;
    bool prepared = false;
    GLuint picture = 0; ///< of the last run; 0 = there was none since prepare()
};

namespace {

/// The pass that first writes to a target.
const std::string& writer_of(const Plan& plan, std::size_t target) {
    static const std::string nobody;
    const auto writes = [&](const Pass& pass) {
        return std::any_of(pass.outputs.begin(), pass.outputs.end(),
                           [&](const ImageRef& output) { return std::cmp_equal(output.index, target); });
    };
    const auto found = std::find_if(plan.passes.begin(), plan.passes.end(), writes);
    return found == plan.passes.end() ? nobody : found->name;
}

/// Take from `old` a texture of that size and format, or make one.
TexturePtr reuse_or_make(std::vector<TexturePtr>& old, const Target& target) {
    const auto found = std::find_if(old.begin(), old.end(), [&](const TexturePtr& texture) {
        return texture && texture->width() == target.width && texture->height() == target.height
               && texture->format() == target.format;
    });
    return found != old.end() ? std::move(*found)
                              : std::make_shared<gl::Texture>(target.width, target.height, target.format);
}

bool counts_taps(const Plan& plan) {
    return std::any_of(plan.passes.begin(), plan.passes.end(),
                       [](const Pass& pass) { return pass.program->counts_taps; });
}

bool has_tiles(const Plan& plan) {
    return std::any_of(plan.passes.begin(), plan.passes.end(),
                       [](const Pass& pass) { return pass.where.kind != ImageRef::Kind::none; });
}

ProgramCount count_programs(const Plan& plan, const ProgramCache& cache) {
    std::map<std::uint64_t, const ProgramSource*> sources;
    for (const Pass& pass : plan.passes)
        sources[pass.program->key] = pass.program.get();
    if (has_tiles(plan)) {
        for (const ProgramSource& source : tile_programs())
            sources[source.key] = &source;
    }
    ProgramCount count;
    count.all = static_cast<int>(sources.size());
    count.compiled = static_cast<int>(std::count_if(
        sources.begin(), sources.end(), [&](const auto& source) { return !cache.holds(*source.second); }));
    return count;
}

gl::StateUse state_use(const Plan& plan) {
    gl::StateUse use{.texture_units = 1, .buffer_texture_unit = has_tiles(plan), .storage_buffers = 1};
    for (const Pass& pass : plan.passes)
        use.texture_units = std::max(use.texture_units, pass.inputs.size());
    if (!plan.decisions.empty() || has_tiles(plan))
        use.storage_buffers = gl::SavedState::most_storage_buffers;
    return use;
}

/// Same passes into the same targets: only numbers in the uniform blocks may differ.
bool same_structure(const Plan& a, const Plan& b) {
    const auto same_target = [](const Target& x, const Target& y) {
        return x.width == y.width && x.height == y.height && x.format == y.format;
    };
    const auto same_pass = [](const Pass& x, const Pass& y) {
        return x.program->key == y.program->key && x.outputs == y.outputs && x.name == y.name
               && x.uniform_block.size() == y.uniform_block.size() && x.condition == y.condition
               && x.where == y.where && x.tile_side == y.tile_side;
    };
    return std::equal(a.targets.begin(), a.targets.end(), b.targets.begin(), b.targets.end(), same_target)
           && std::equal(a.passes.begin(), a.passes.end(), b.passes.begin(), b.passes.end(), same_pass);
}

} // namespace

Executor::Executor(std::filesystem::path program_cache)
    : Executor(ExecutorOptions{.program_cache = std::move(program_cache)}) {}
Executor::Executor(ExecutorOptions options) : state_(std::make_unique<State>(std::move(options))) {}
Executor::Executor(Executor&&) noexcept = default;

Executor::~Executor() {
    const gl::LeaveObjects leave(state_ && !state_->context.is_current());
    state_.reset();
}

Executor& Executor::operator=(Executor&& other) noexcept {
    std::swap(state_, other.state_); // what was here ends with `other`, in its own context or without it
    return *this;
}

void Executor::prepare(const Plan& plan, const std::vector<Format>& formats) {
    State& state = *state_;
    state.expect_context();
    if (!state.current.passes.empty() && same_structure(plan, state.current.plan)) {
        for (std::size_t i = 0; i < plan.passes.size(); ++i) {
            const auto& bytes = plan.passes[i].uniform_block;
            if (bytes != state.current.plan.passes[i].uniform_block) {
                glNamedBufferSubData(state.current.passes[i].block.name(), 0, std::ssize(bytes),
                                     bytes.data());
            }
        }
        state.current.plan = plan;
        return;
    }

    check_limits(plan, device_limits());
    State::Ready ready;
    ready.programs = count_programs(plan, state.programs);
    if (ready.programs.compiled > 0 && !formats.empty() && WarmUp::helps(state.programs))
        ready.warm_up = std::make_unique<WarmUp>(plan, formats, state.programs.directory());
    for (const Pass& pass : plan.passes)
        ready.passes.push_back({pass.name, state.programs.get(*pass.program, pass.name), {}, {}});
    // A copy of the list: whatever fails below, the plan before keeps its targets.
    std::vector<TexturePtr> old = state.current.targets;
    for (std::size_t i = 0; i < plan.targets.size(); ++i) {
        try {
            ready.targets.push_back(reuse_or_make(old, plan.targets[i]));
        } catch (const Error& error) {
            throw Error(Place{.effect = writer_of(plan, i)}, error.message());
        }
    }
    for (std::size_t i = 0; i < plan.passes.size(); ++i) {
        std::vector<GLuint> outputs;
        for (const ImageRef& output : plan.passes[i].outputs)
            outputs.push_back(ready.targets[output.index]->name());
        if (!outputs.empty()) ready.passes[i].framebuffer = gl::make_framebuffer(outputs);
        const auto& bytes = plan.passes[i].uniform_block;
        if (!bytes.empty()) ready.passes[i].block = gl::make_buffer(bytes.size(), bytes.data());
    }
    if (!plan.decisions.empty()) ready.decisions.emplace(plan);
    if (has_tiles(plan)) ready.tiles.emplace(plan, state.programs);
    if (counts_taps(plan)) ready.taps.emplace(plan.passes.size());
    ready.state_use = state_use(plan);
    ready.plan = plan;
    state.current = std::move(ready);
    state.profile.assign(plan.passes.size(), {});
    state.ring.reset();
    state.watch.reset();
    state.last_timing = Timing::off;
    state.last_watch = Watch::off;
    state.prepared = true;
    state.picture = 0;
}

void Executor::State::check(const FrameInputs& inputs) const {
    if (!prepared) throw Error("run() before any prepare()");
    expect_context();
    check_textures(current.plan, inputs.textures, [&](std::uint32_t texture) { return owns(texture); });
    check_camera(inputs.camera);
    check_time(inputs.time);
}

void Executor::State::draw(const FrameInputs& inputs, Timing timing, Watch watch_for) {
    const Plan& plan = current.plan;
    gl::set_pass_state(); // before the clock is checked, which draws too
    if (timing == Timing::gpu && !ring) ring.emplace(plan.passes.size());
    if (timing != Timing::off && !clock) clock = gl::check_clock();
    last_timing = timing;
    if (watch_for == Watch::nonfinite && !watch) watch.emplace(plan);
    last_watch = watch_for;

    begin_frame(block_of(plan, inputs));
    if (watch_for == Watch::nonfinite) {
        watch->begin_frame();
        for (GLuint attachment : inputs.textures)
            watch->count(attachment, plan.width, plan.height);
    }
    if (timing == Timing::gpu) {
        ring->begin_frame();
        ring->mark();
    } else if (timing == Timing::profile) {
        glFinish();
    }
    for (std::size_t i = 0; i < plan.passes.size(); ++i) {
        const gl::HostTime start = timing == Timing::profile ? gl::HostTime::now() : gl::HostTime{};
        if (current.warm_up) current.warm_up->leave(i);
        execute(i, inputs.textures);
        if (timing == Timing::profile) {
            glFinish();
            const gl::HostTime end = gl::HostTime::now();
            profile[i] = {end.cpu_ms - start.cpu_ms, end.wall_ms - start.wall_ms};
        } else if (timing == Timing::gpu) {
            ring->mark();
        }
        if (watch_for == Watch::nonfinite) {
            for (const ImageRef& output : plan.passes[i].outputs) {
                watch->count(texture(current, output, inputs.textures), plan.passes[i].width,
                             plan.passes[i].height);
            }
            if (timing == Timing::profile) glFinish(); // not to be counted in the next pass's time
        }
    }
    if (timing == Timing::gpu) ring->end_frame();
    if (current.warm_up) {
        current.programs.warmed = current.warm_up->warmed();
        current.warm_up.reset();
    }

    picture = texture(current, plan.picture, inputs.textures);
}

std::uint32_t Executor::run(const FrameInputs& inputs, Timing timing, Watch watch) {
    State& state = *state_;
    state.check(inputs);
    const std::optional<gl::SavedState> saved = state.save_gl_state();
    state.draw(inputs, timing, watch);
    state.end_frame();
    return state.picture;
}

void Executor::run(const FrameInputs& inputs, const OutputTarget& output, Timing timing, Watch watch) {
    State& state = *state_;
    state.check(inputs);
    check_output(output);
    const std::optional<gl::SavedState> saved = state.save_gl_state();
    state.draw(inputs, timing, watch);
    if (!state.output) state.output.emplace();
    state.output->draw(state.picture, state.current.plan.width, state.current.plan.height, output);
    state.end_frame();
}

void Executor::compile(const std::vector<std::uint32_t>& textures) {
    const State& state = *state_;
    state.expect_context();
    const std::optional<gl::SavedState> saved = state.save_gl_state();
    state.begin_frame({});
    glEnable(GL_RASTERIZER_DISCARD);
    for (std::size_t i = 0; i < state.current.plan.passes.size(); ++i)
        state.execute(i, textures);
    glDisable(GL_RASTERIZER_DISCARD);
    state.end_frame();
}

Report Executor::report() const {
    const State& state = *state_;
    state.expect_context();
    const Plan& plan = state.current.plan;
    Report report = describe(plan);
    report.programs = state.current.programs;
    report.clock = "none: times were not asked for";
    if (state.current.decisions && state.picture)
        tell_decisions(state.current.decisions->read(), plan, report);
    if (state.current.tiles && state.picture) tell_tiles(state.current.tiles->read(), report);
    if (state.current.taps && state.picture) tell_taps(state.current.taps->read(), report);
    if (state.last_watch == Watch::nonfinite) report.nonfinite = nonfinite_images(plan, state.watch->read());
    if (state.last_timing == Timing::profile) tell_profile(state.profile, state.clock->text, report);
    if (state.last_timing == Timing::gpu && state.clock->timer_queries_honest)
        tell_gpu_times(state_->ring->latest(), state.clock->text, report);
    else if (state.last_timing == Timing::gpu)
        report.clock = "none to be believed: " + state.clock->text;
    return report;
}

Image Executor::read_picture() const {
    const State& state = *state_;
    const Plan& plan = state.current.plan;
    if (!state.picture) throw Error("read_picture() before any run()");
    state.expect_context();
    // An input that came through untouched is read as floats: wide enough for any format that it may have.
    const bool own = plan.picture.kind == ImageRef::Kind::target;
    const Format format = own ? plan.targets[plan.picture.index].format : Format::rgba32f;
    return gl::read_texture(state.picture, plan.width, plan.height, format);
}

} // namespace postfx
