#include <plan/assemble.hpp>
#include <plan/record.hpp>
#include <plan/targets.hpp>

#include <postfx/error.hpp>
#include <postfx/plan.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace postfx {
namespace {

constexpr std::size_t most_uniform_bytes = 16384; // of a block; GL 4.5 promises no more

const ImageRef nothing{};

/// A compose function that waits to be drawn, with the images that its samplers read.
struct WaitingStage {
    Stage stage;
    std::vector<PassInput> inputs;
    std::size_t effect = 0; ///< into Plan::effects
    std::size_t bytes = 0;  ///< of its parameter struct
};

/// Walks along the chain once. `stored_` is the picture so far; `waiting_` are functions of its pixels that
/// were not drawn yet, because those after them may join them in one pass.
class Walk {
public:
    /// A program by what it is made of. Its effects are kept, so that their addresses, which are part of the
    /// key, are not given to others.
    struct KnownProgram {
        std::shared_ptr<const ProgramSource> source;
        std::vector<EffectPtr> effects;
    };
    using Programs = std::unordered_map<std::string, KnownProgram>;

    Walk(const Facts& facts, Programs& programs)
        : facts_(facts), programs_(programs), frame_(frame_block(facts.width, facts.height, facts.camera)) {
        plan_.width = facts.width;
        plan_.height = facts.height;
        stored_ = attachment("color");
    }

    void add(const ChainEntry& given) {
        const ChainEntry entry = within_ranges(given);
        plan_.effects.push_back({entry.name, entry.effect->id, EffectStatus::ran, "", "", ""});
        if (!entry.enabled) return skip({"configuration", "exact", "enabled is false"});
        const Recording recording = record(entry, facts_);
        if (recording.identity) return skip(*recording.identity);
        warn_about_order(entry);
        add_passes(entry, recording);
    }

    Plan finish() {
        const Encoding encoding = final_encoding();
        if (!waiting_.empty() || encoding != Encoding::none) flush(encoding, "the chain ends");
        plan_.picture = stored_;
        drop_unread_passes(plan_);
        share_targets(plan_);
        keep_read_attachments(plan_);
        return std::move(plan_);
    }

private:
    /// Files are checked where they are read; values that a host set itself are held to their ranges here.
    ChainEntry within_ranges(ChainEntry entry) {
        for (std::size_t i = 0; i < entry.values.size(); ++i) {
            const ParameterInfo& parameter = entry.effect->parameters[i];
            for (int c = 0; c < parameter.components(); ++c) {
                double& value = entry.values[i][c];
                const double given = value;
                value = std::isnan(given) ? parameter.default_value[c]
                                          : std::clamp(given, parameter.minimum, parameter.maximum);
                if (value == given) continue;
                plan_.warnings.push_back(fmt::format("{}: {} is {}, which is not within {} to {}; {} is used",
                                                     entry.name, parameter.id, given, parameter.minimum,
                                                     parameter.maximum, value));
            }
        }
        return entry;
    }

    void skip(const Identity& identity) {
        PlannedEffect& planned = plan_.effects.back();
        planned.status = EffectStatus::skipped;
        planned.moment = identity.moment;
        planned.kind = identity.kind;
        planned.reason = identity.reason;
    }

    ImageRef attachment(const std::string& name) {
        std::vector<std::string>& names = plan_.attachments;
        const auto index = std::find(names.begin(), names.end(), name) - names.begin();
        if (index == std::ssize(names)) names.push_back(name);
        return {ImageRef::Kind::attachment, static_cast<int>(index)};
    }

    Numbers numbers_of(int width, int height) const { return {width, height, facts_.fold, frame_}; }

    ImageRef new_target(int width, int height, Format format) {
        plan_.targets.push_back({width, height, format});
        return {ImageRef::Kind::target, static_cast<int>(plan_.targets.size()) - 1};
    }

    void add_passes(const ChainEntry& entry, const Recording& recording) {
        std::vector<std::vector<ImageRef>> outputs; // of each of the effect's passes
        for (const RecordedPass& pass : recording.passes) {
            if (recording.reads_color(pass) && !waiting_.empty()) {
                flush(Encoding::none,
                      fmt::format("{} samples the stored picture ({})", entry.name, pass.name));
            }
            std::vector<PassInput> inputs;
            for (const RecordedInput& input : pass.inputs) {
                inputs.push_back({input.name, resolve(recording.images[input.image], outputs), input.linear});
            }
            if (pass.compose) {
                Stage stage = make_stage(entry, pass);
                const std::size_t bytes = struct_bytes(stage);
                wait({std::move(stage), std::move(inputs), plan_.effects.size() - 1, bytes});
            } else {
                outputs.push_back(add_fragment_pass(entry, pass, std::move(inputs)));
            }
        }
    }

    ImageRef resolve(const RecordedImage& image, const std::vector<std::vector<ImageRef>>& outputs) {
        switch (image.kind) {
        case RecordedImage::Kind::color:
            return stored_;
        case RecordedImage::Kind::attachment:
            return attachment(image.attachment);
        case RecordedImage::Kind::output:
            return outputs[image.pass][image.output];
        }
        return nothing;
    }

    std::vector<ImageRef> add_fragment_pass(const ChainEntry& entry, const RecordedPass& recorded,
                                            std::vector<PassInput> inputs) {
        const std::vector<Stage> stages = {make_stage(entry, recorded)};
        Pass pass;
        pass.name = entry.name + "/" + recorded.name;
        pass.effects = {entry.name};
        const int output_count = static_cast<int>(recorded.formats.size());
        const Numbers numbers = numbers_of(recorded.width, recorded.height);
        pass.program = program(stages, fmt::format("fragment {}", output_count), numbers,
                               [&] { return assemble_fragment(stages.front(), output_count, numbers); });
        pass.inputs = std::move(inputs);
        for (Format format : recorded.formats) {
            pass.outputs.push_back(new_target(recorded.width, recorded.height, format));
        }
        pass.width = recorded.width;
        pass.height = recorded.height;
        pass.format = recorded.formats.front();
        pass.uniform_block = uniform_block(stages, numbers);
        plan_.passes.push_back(std::move(pass));
        return plan_.passes.back().outputs;
    }

    /// Let a compose function join those that wait, or draw them first and say why.
    void wait(WaitingStage stage) {
        std::string apart = facts_.fuse || waiting_.empty() ? "" : "fusion is off";
        std::size_t inputs = 1 + stage.inputs.size();
        std::size_t bytes = block_head_bytes + stage.bytes;
        for (const WaitingStage& other : waiting_) {
            if (apart.empty()) apart = why_not_together(other.stage, stage.stage);
            inputs += other.inputs.size();
            bytes += other.bytes;
        }
        if (apart.empty() && inputs > most_pass_inputs) {
            apart = fmt::format("{} would need {} textures in one pass, {} are sure", stage.stage.entry,
                                inputs, most_pass_inputs);
        }
        if (apart.empty() && bytes > most_uniform_bytes) {
            apart = fmt::format("{} would need {} bytes of uniforms in one pass, {} are sure",
                                stage.stage.entry, bytes, most_uniform_bytes);
        }
        if (!apart.empty() && !waiting_.empty()) flush(Encoding::none, apart);
        waiting_.push_back(std::move(stage));
    }

    /// Draw what waits as one pass; `because` is why nothing more can join it.
    void flush(Encoding encoding, const std::string& because) {
        std::vector<Stage> stages;
        Pass pass;
        pass.inputs.push_back({"color", stored_, false});
        for (const WaitingStage& waiting : waiting_) {
            stages.push_back(waiting.stage);
            pass.effects.push_back(waiting.stage.entry);
            pass.inputs.insert(pass.inputs.end(), waiting.inputs.begin(), waiting.inputs.end());
        }
        explain_fusion(because);
        std::vector<std::string> parts = pass.effects;
        if (encoding != Encoding::none) parts.emplace_back("output");
        pass.name = fmt::format("{}", fmt::join(parts, "+"));
        const Numbers numbers = numbers_of(facts_.width, facts_.height);
        pass.program = program(stages, fmt::format("compose {}", static_cast<int>(encoding)), numbers,
                               [&] { return assemble_compose(stages, encoding, numbers); });
        pass.format = encoding == Encoding::none ? facts_.working_format : Format::rgba8;
        pass.outputs = {new_target(facts_.width, facts_.height, pass.format)};
        pass.width = facts_.width;
        pass.height = facts_.height;
        pass.uniform_block = uniform_block(stages, numbers);
        plan_.passes.push_back(std::move(pass));
        stored_ = plan_.passes.back().outputs.front();
        waiting_.clear();
    }

    void explain_fusion(const std::string& because) {
        for (const WaitingStage& waiting : waiting_) {
            PlannedEffect& planned = plan_.effects[waiting.effect];
            std::vector<std::string> others;
            for (const WaitingStage& other : waiting_) {
                if (other.effect != waiting.effect) others.push_back(other.stage.entry);
            }
            if (!others.empty()) planned.status = EffectStatus::fused;
            planned.reason = others.empty() ? fmt::format("a pass of its own; after it {}", because)
                                            : fmt::format("one pass with {}; after it {}",
                                                          fmt::join(others, ", "), because);
        }
    }

    template<class Make>
    std::shared_ptr<const ProgramSource> program(const std::vector<Stage>& stages, const std::string& form,
                                                 const Numbers& numbers, Make make) {
        KnownProgram& found = programs_[program_key(stages, form, numbers)];
        if (!found.source) {
            found.source = std::make_shared<const ProgramSource>(make());
            for (const Stage& stage : stages)
                found.effects.push_back(stage.effect);
        }
        return found.source;
    }

    Encoding final_encoding() const {
        if (facts_.output == Output::linear) return Encoding::none;
        const bool nothing_ran =
            std::all_of(plan_.effects.begin(), plan_.effects.end(),
                        [](const PlannedEffect& e) { return e.status == EffectStatus::skipped; });
        // Dithering codes that were 8 bits to begin with would only change them.
        return facts_.color_is_8bit && nothing_ran ? Encoding::srgb : Encoding::srgb_dithered;
    }

    void warn_about_order(const ChainEntry& entry) {
        const std::string& stage = entry.effect->stage;
        if (stage != "display" && !display_since_.empty()) {
            plan_.warnings.push_back(
                fmt::format("{} works on scene-linear light, but stands after {}, which made it "
                            "display light",
                            entry.name, display_since_));
        }
        if (stage == "scene_to_display") {
            if (!early_display_.empty()) {
                plan_.warnings.push_back(
                    fmt::format("{} belongs after {}, which makes the display light that it "
                                "works on",
                                early_display_, entry.name));
            }
            display_since_ = entry.name;
        } else if (stage == "display" && display_since_.empty()) {
            early_display_ = entry.name;
        }
    }

    const Facts& facts_;
    Programs& programs_;
    FrameBlock frame_;
    Plan plan_;
    ImageRef stored_;
    std::vector<WaitingStage> waiting_;
    std::string display_since_; ///< the tone map passed, if any
    std::string early_display_; ///< a display effect passed before any tone map
};

} // namespace

std::string_view status_name(EffectStatus status) {
    switch (status) {
    case EffectStatus::ran:
        return "ran";
    case EffectStatus::fused:
        return "fused";
    case EffectStatus::skipped:
        return "skipped";
    }
    return "";
}

std::size_t Target::bytes() const {
    return static_cast<std::size_t>(width) * height * format_info(format).bytes_per_pixel;
}

std::size_t Plan::texture_bytes() const {
    std::size_t bytes = 0;
    for (const Target& target : targets)
        bytes += target.bytes();
    return bytes;
}

struct Planner::Memory {
    Walk::Programs programs;
};

Planner::Planner() : memory_(std::make_unique<Memory>()) {}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;

Plan Planner::plan(const Chain& chain, const Facts& facts) {
    if (facts.width < 1 || facts.height < 1) {
        throw Error(fmt::format("a picture of {}x{} pixels can't be planned", facts.width, facts.height));
    }
    Walk walk(facts, memory_->programs);
    for (const ChainEntry& entry : chain.entries)
        walk.add(entry);
    return walk.finish();
}

} // namespace postfx
