#include <plan/draft.hpp>
#include <plan/frame_questions.hpp>
#include <plan/fusion.hpp>
#include <plan/record.hpp>
#include <plan/targets.hpp>

#include <postfx/error.hpp>
#include <postfx/plan.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace postfx {
namespace {

/// Files are checked where they are read; values that a host set itself are held to their ranges here.
ChainEntry within_ranges(ChainEntry entry, std::vector<std::string>& warnings) {
    for (std::size_t i = 0; i < entry.values.size(); ++i) {
        const ParameterInfo& parameter = entry.effect->parameters[i];
        for (int c = 0; c < parameter.components(); ++c) {
            double& value = entry.values[i][c];
            const double given = value;
            value = std::isnan(given) ? parameter.default_value[c]
                                      : std::clamp(given, parameter.minimum, parameter.maximum);
            if (value == given) continue;
            warnings.push_back(fmt::format("{}: {} is {}, which is not within {} to {}; {} is used",
                                           entry.name, parameter.id, given, parameter.minimum,
                                           parameter.maximum, value));
        }
    }
    return entry;
}

/// Walks along the chain once, and adds what every effect asks for to the draft.
class Walk {
public:
    Walk(const SceneFacts& facts, const PlanOptions& options, Skip skip, KnownPrograms& programs,
         std::vector<std::string> warnings)
        : draft_(facts, options, programs, std::move(warnings)), skip_(skip) {}

    /// `codes`: how strongly the picture shows changes of what this effect gives.
    void add(const ChainEntry& entry, const Codes& codes) {
        draft_.plan().effects.push_back({entry.name, entry.effect->id});
        if (!entry.enabled) return skip({Moment::configuration, SkipKind::exact, "enabled is false"});
        const Recording recording =
            record(entry, draft_.facts(), draft_.options().working_format, skip_, codes);
        if (recording.identity) return skip(*recording.identity);
        warn_about_order(entry);
        if (recording.decision && questions_.has_room()) ask(entry, recording);
        add_passes(entry, recording);
    }

    Plan finish() {
        const Finish finish = final_finish();
        if (fusion_.is_anything_waiting() || finish.encoding != Encoding::none)
            fusion_.flush(finish, "the chain ends");
        Plan& plan = draft_.plan();
        plan.picture = fusion_.one_image();
        drop_unread_passes(plan);
        share_targets(plan);
        keep_read_attachments(plan);
        return std::move(plan);
    }

private:
    void skip(const Identity& identity) {
        PlannedEffect& planned = draft_.effect();
        planned.status = EffectStatus::skipped;
        planned.moment = identity.moment;
        planned.kind = identity.kind;
        planned.reason = identity.reason;
    }

    void ask(const ChainEntry& entry, const Recording& recording) {
        if (recording.reads_color(recording.decision->pass) && fusion_.is_anything_waiting())
            fusion_.flush(Finish{}, fmt::format("{} asks what is in the stored picture", entry.name));
        questions_.ask(entry, recording);
    }

    void add_passes(const ChainEntry& entry, const Recording& recording) {
        std::vector<std::vector<ImageRef>> outputs; // of each of the effect's passes
        for (const RecordedPass& pass : recording.passes) {
            if (recording.reads_color(pass) && fusion_.is_anything_waiting()) {
                fusion_.flush(Finish{},
                              fmt::format("{} samples the stored picture ({})", entry.name, pass.name));
            }
            std::vector<PassInput> inputs;
            for (const RecordedInput& input : pass.inputs) {
                inputs.push_back({input.name, resolve(recording.images[input.image], outputs), input.linear});
            }
            if (pass.compose) {
                Stage stage = make_stage(entry, pass);
                const std::size_t bytes = struct_bytes(stage);
                fusion_.wait({std::move(stage), std::move(inputs), draft_.plan().effects.size() - 1, bytes,
                              draft_.effect().decision});
            } else {
                outputs.push_back(add_fragment_pass(entry, recording, pass, std::move(inputs), outputs));
            }
        }
    }

    ImageRef resolve(const RecordedImage& image, const std::vector<std::vector<ImageRef>>& outputs) {
        switch (image.kind) {
        case RecordedImage::Kind::color:
            return the_picture;
        case RecordedImage::Kind::attachment:
            return draft_.attachment(image.attachment);
        case RecordedImage::Kind::output:
            return outputs[image.pass][image.output];
        }
        return the_picture;
    }

    /// When the passes of the effect that is being added are drawn.
    Condition own_condition() {
        const int decision = draft_.effect().decision;
        return decision < 0 ? Condition{} : Condition{Term{1u << decision, 0}};
    }

    /// `before`: outputs of the effect's passes before this one. Returns its own.
    std::vector<ImageRef> add_fragment_pass(const ChainEntry& entry, const Recording& recording,
                                            const RecordedPass& recorded, std::vector<PassInput> inputs,
                                            const std::vector<std::vector<ImageRef>>& before) {
        const std::vector<Stage> stages = {make_stage(entry, recorded)};
        Pass pass;
        pass.name = entry.name + "/" + recorded.name;
        pass.effects = {entry.name};
        const int output_count = static_cast<int>(recorded.formats.size());
        const Numbers numbers = draft_.numbers_of(recorded.width, recorded.height);
        const bool tiled = recorded.where >= 0;
        pass.program =
            draft_.program(stages, fmt::format("fragment {}{}", output_count, tiled ? " tiled" : ""), numbers,
                           [&] { return assemble_fragment(stages.front(), output_count, tiled, numbers); });
        pass.inputs = std::move(inputs);
        for (Format format : recorded.formats) {
            pass.outputs.push_back(draft_.new_target(recorded.width, recorded.height, format));
        }
        pass.width = recorded.width;
        pass.height = recorded.height;
        pass.format = recorded.formats.front();
        pass.uniform_block = uniform_block(stages, numbers);
        if (tiled) {
            const RecordedImage& mask = recording.images[recorded.where];
            pass.where = resolve(mask, before);
            pass.tiles_across = mask.width;
            pass.tiles_down = mask.height;
            pass.tile_side = recorded.tile_side;
        }
        draft_.emit(pass, own_condition());
        return pass.outputs;
    }

    Finish final_finish() const {
        if (draft_.options().output == Output::linear) return {};
        const bool nothing_ran =
            std::all_of(draft_.plan().effects.begin(), draft_.plan().effects.end(),
                        [](const PlannedEffect& e) { return e.status == EffectStatus::skipped; });
        // Dithering codes that were 8 bits to begin with would only change them.
        const bool keeps_codes = draft_.facts().color_is_8bit && nothing_ran;
        return {keeps_codes ? Encoding::srgb : Encoding::srgb_dithered, draft_.options().divide_by_alpha};
    }

    void warn_about_order(const ChainEntry& entry) {
        const EffectStage stage = entry.effect->stage;
        if (stage != EffectStage::display && !display_since_.empty()) {
            draft_.plan().warnings.push_back(
                fmt::format("{} works on scene-linear light, but stands after {}, which made it "
                            "display light",
                            entry.name, display_since_));
        }
        if (stage == EffectStage::scene_to_display) {
            if (!early_display_.empty()) {
                draft_.plan().warnings.push_back(
                    fmt::format("{} belongs after {}, which makes the display light that it "
                                "works on",
                                early_display_, entry.name));
            }
            display_since_ = entry.name;
        } else if (stage == EffectStage::display && display_since_.empty()) {
            early_display_ = entry.name;
        }
    }

    PlanDraft draft_;
    Fusion fusion_{draft_};
    FrameQuestions questions_{draft_};
    Skip skip_;
    std::string display_since_; ///< the tone map passed, if any
    std::string early_display_; ///< a display effect passed before any tone map
};

} // namespace

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
    KnownPrograms programs;
};

Planner::Planner() : memory_(std::make_unique<Memory>()) {}
Planner::~Planner() = default;
Planner::Planner(Planner&&) noexcept = default;
Planner& Planner::operator=(Planner&&) noexcept = default;

Plan Planner::plan(const Chain& chain, const SceneFacts& facts, const PlanOptions& options) {
    if (facts.width < 1 || facts.height < 1) {
        throw Error(fmt::format("a picture of {}x{} pixels can't be planned", facts.width, facts.height));
    }
    std::vector<std::string> warnings;
    std::vector<ChainEntry> entries;
    for (const ChainEntry& entry : chain.entries)
        entries.push_back(within_ranges(entry, warnings));
    std::vector<Codes> codes(entries.size() + 1, display_codes()); // before each effect, and behind the last
    for (std::size_t i = entries.size(); i-- > 0;)
        codes[i] = entries[i].enabled ? codes_before(entries[i], facts, codes[i + 1]) : codes[i + 1];
    Walk walk(facts, options, chain.skip, memory_->programs, std::move(warnings));
    for (std::size_t i = 0; i < entries.size(); ++i)
        walk.add(entries[i], codes[i + 1]);
    return walk.finish();
}

} // namespace postfx
