#include <plan/assemble.hpp>
#include <plan/condition.hpp>
#include <plan/record.hpp>
#include <plan/targets.hpp>

#include <postfx/error.hpp>
#include <postfx/plan.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <unordered_map>

namespace postfx {
namespace {

constexpr std::size_t most_uniform_bytes = 16384; // of a block; GL 4.5 promises no more

/// Programs double with each: one with the effect's code, one without.
constexpr int most_decisions_in_a_pass = 3;

/// Stands for the picture so far, whichever image it is in.
const ImageRef the_picture{};

/// One of the images that the picture so far may be in, by what the frame decided.
struct Alternative {
    ImageRef image;
    Condition condition;
};

/// A compose function that waits to be drawn, with the images that its samplers read.
struct WaitingStage {
    Stage stage;
    std::vector<PassInput> inputs;
    std::size_t effect = 0; ///< into Plan::effects
    std::size_t bytes = 0;  ///< of its parameter struct
    int decision = -1;      ///< into Plan::decisions, if the frame decides
};

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

/// Walks along the chain once. `stored_` is the picture so far: one image, or, behind effects that the frame decides
/// on, alternatives of which exactly one holds. `waiting_` are functions of its pixels that were not drawn yet,
/// because those after them may join them in one pass.
class Walk {
public:
    /// A program by what it is made of. Its effects are kept, so that their addresses, which are part of the
    /// key, are not given to others.
    struct KnownProgram {
        std::shared_ptr<const ProgramSource> source;
        std::vector<EffectPtr> effects;
    };
    using Programs = std::unordered_map<std::string, KnownProgram>;

    Walk(const SceneFacts& facts, const PlanOptions& options, Skip skip, Programs& programs,
         std::vector<std::string> warnings)
        : facts_(facts), options_(options), skip_(skip), programs_(programs),
          frame_(frame_block(facts.width, facts.height, facts.camera)) {
        plan_.warnings = std::move(warnings);
        plan_.width = facts.width;
        plan_.height = facts.height;
        stored_ = {{attachment("color"), {}}};
    }

    /// `codes`: how strongly the picture shows changes of what this effect gives.
    void add(const ChainEntry& entry, const Codes& codes) {
        plan_.effects.push_back({entry.name, entry.effect->id});
        if (!entry.enabled) return skip({Moment::configuration, SkipKind::exact, "enabled is false"});
        const Recording recording = record(entry, facts_, options_.working_format, skip_, codes);
        if (recording.identity) return skip(*recording.identity);
        warn_about_order(entry);
        if (recording.decision) add_decision(entry, recording);
        add_passes(entry, recording);
    }

    Plan finish() {
        const Finish finish = final_finish();
        if (!waiting_.empty() || finish.encoding != Encoding::none) flush(finish, "the chain ends");
        plan_.picture = one_image();
        drop_unread_passes(plan_);
        share_targets(plan_);
        keep_read_attachments(plan_);
        return std::move(plan_);
    }

private:
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

    Numbers numbers_of(int width, int height) const {
        return {width, height, options_.fold, options_.count_taps, frame_};
    }

    ImageRef new_target(int width, int height, Format format) {
        plan_.targets.push_back({width, height, format});
        return {ImageRef::Kind::target, static_cast<int>(plan_.targets.size()) - 1};
    }

    void add_passes(const ChainEntry& entry, const Recording& recording) {
        std::vector<std::vector<ImageRef>> outputs; // of each of the effect's passes
        for (const RecordedPass& pass : recording.passes) {
            if (recording.reads_color(pass) && !waiting_.empty()) {
                flush(Finish{}, fmt::format("{} samples the stored picture ({})", entry.name, pass.name));
            }
            std::vector<PassInput> inputs;
            for (const RecordedInput& input : pass.inputs) {
                inputs.push_back({input.name, resolve(recording.images[input.image], outputs), input.linear});
            }
            if (pass.compose) {
                Stage stage = make_stage(entry, pass);
                const std::size_t bytes = struct_bytes(stage);
                wait({std::move(stage), std::move(inputs), plan_.effects.size() - 1, bytes,
                      plan_.effects.back().decision});
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
            return attachment(image.attachment);
        case RecordedImage::Kind::output:
            return outputs[image.pass][image.output];
        }
        return the_picture;
    }

    /// Append the pass, drawn under `condition`: once for each image that the picture may be in, if it reads that.
    void emit(const Pass& pass, const Condition& condition) {
        const auto is_picture = [](const PassInput& input) { return input.image == the_picture; };
        if (std::none_of(pass.inputs.begin(), pass.inputs.end(), is_picture)) {
            plan_.passes.push_back(pass);
            plan_.passes.back().condition = condition;
            return;
        }
        for (const Alternative& alternative : stored_) {
            const std::optional<Condition> holding = both(condition, alternative.condition);
            if (!holding) continue;
            plan_.passes.push_back(pass);
            Pass& emitted = plan_.passes.back();
            emitted.condition = *holding;
            for (PassInput& input : emitted.inputs) {
                if (is_picture(input)) input.image = alternative.image;
            }
        }
    }

    /// When the passes of the effect that is being added are drawn.
    Condition own_condition() const {
        const int decision = plan_.effects.back().decision;
        return decision < 0 ? Condition{} : Condition{Term{1u << decision, 0}};
    }

    void add_decision(const ChainEntry& entry, const Recording& recording) {
        const RecordedDecision& asked = *recording.decision;
        if (plan_.decisions.size() == max_decisions) return; // it runs in every frame
        if (recording.reads_color(asked.pass) && !waiting_.empty()) {
            flush(Finish{}, fmt::format("{} asks what is in the stored picture", entry.name));
        }
        std::vector<CensusInput> censuses;
        for (const RecordedInput& input : asked.pass.inputs)
            censuses.push_back(census_of(recording.images[input.image]));
        const int decision = static_cast<int>(plan_.decisions.size());
        plan_.decisions.push_back(asked.decision);
        plan_.effects.back().decision = decision;

        const Stage stage = make_stage(entry, asked.pass);
        const Numbers numbers = numbers_of(facts_.width, facts_.height);
        std::string form = fmt::format("decision {}", decision);
        Pass pass;
        pass.kind = PassKind::decide;
        pass.slot = decision;
        for (const CensusInput& census : censuses) {
            pass.censuses.push_back(census.slot);
            form += fmt::format(" {}{}", census.slot, census.depth ? "d" : "");
        }
        pass.name = entry.name + "/decision";
        pass.effects = {entry.name};
        pass.program = program({stage}, form, numbers,
                               [&] { return assemble_decision(stage, decision, censuses, numbers); });
        pass.uniform_block = uniform_block({stage}, numbers);
        pass.width = pass.height = 1;
        plan_.passes.push_back(std::move(pass));
    }

    /// Count every image once, however many ask.
    CensusInput census_of(const RecordedImage& image) {
        const bool of_picture = image.kind == RecordedImage::Kind::color;
        const bool depth = image.attachment == "depth";
        const std::string name = of_picture ? fmt::format("picture {}", pictures_stored_) : image.attachment;
        const auto [found, is_new] = censuses_.try_emplace(name, plan_.censuses);
        if (!is_new) return {found->second, depth};
        const Numbers numbers = numbers_of(facts_.width, facts_.height);
        Pass pass;
        pass.kind = PassKind::census;
        pass.slot = plan_.censuses++;
        pass.name = fmt::format("census of {}", of_picture ? "the picture" : name);
        pass.program = program({}, depth ? "census depth" : "census", numbers,
                               [&] { return assemble_census(depth, numbers); });
        pass.uniform_block = uniform_block({}, numbers);
        pass.width = facts_.width;
        pass.height = facts_.height;
        pass.inputs = {{name, of_picture ? the_picture : attachment(image.attachment), false}};
        emit(pass, {});
        return {pass.slot, depth};
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
        const Numbers numbers = numbers_of(recorded.width, recorded.height);
        const bool tiled = recorded.where >= 0;
        pass.program =
            program(stages, fmt::format("fragment {}{}", output_count, tiled ? " tiled" : ""), numbers,
                    [&] { return assemble_fragment(stages.front(), output_count, tiled, numbers); });
        pass.inputs = std::move(inputs);
        for (Format format : recorded.formats) {
            pass.outputs.push_back(new_target(recorded.width, recorded.height, format));
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
        emit(pass, own_condition());
        return pass.outputs;
    }

    /// Let a compose function join those that wait, or draw them first and say why.
    void wait(WaitingStage stage) {
        std::string apart = options_.fuse || waiting_.empty() ? "" : "fusion is off";
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
        const auto decisions = std::count_if(waiting_.begin(), waiting_.end(),
                                             [](const WaitingStage& other) { return other.decision >= 0; });
        if (apart.empty() && stage.decision >= 0 && decisions == most_decisions_in_a_pass) {
            apart = fmt::format("the frame would decide on more than {} effects of one pass", decisions);
        }
        if (!apart.empty() && !waiting_.empty()) flush(Finish{}, apart);
        waiting_.push_back(std::move(stage));
    }

    /// Draw what waits as one pass; `because` is why nothing more can join it. Where the frame decides on some of
    /// it, there is a pass for each outcome, with the code of those that live.
    void flush(Finish finish, const std::string& because) {
        explain_fusion(because);
        std::vector<int> decisions;
        for (const WaitingStage& waiting : waiting_) {
            if (waiting.decision >= 0) decisions.push_back(waiting.decision);
        }
        const Format format = finish.encoding == Encoding::none ? options_.working_format : Format::rgba8;
        const ImageRef target = new_target(facts_.width, facts_.height, format);
        std::vector<Alternative> after = {{target, {}}};
        for (std::uint32_t outcome = 0; outcome < 1u << decisions.size(); ++outcome) {
            Term term;
            for (std::size_t i = 0; i < decisions.size(); ++i)
                (outcome >> i & 1u ? term.dead : term.live) |= 1u << decisions[i];
            const Condition condition = decisions.empty() ? Condition{} : Condition{term};
            std::vector<WaitingStage> living;
            std::copy_if(waiting_.begin(), waiting_.end(), std::back_inserter(living),
                         [&](const WaitingStage& waiting) {
                             return waiting.decision < 0 || (term.live >> waiting.decision & 1u) != 0;
                         });
            if (living.empty() && finish.encoding == Encoding::none) {
                for (const Alternative& before : stored_) {
                    if (const auto holding = both(condition, before.condition))
                        after.push_back({before.image, *holding});
                }
                continue;
            }
            emit(composed(living, finish, target), condition);
            if (!decisions.empty()) after.front().condition.push_back(term);
        }
        if (after.size() == 1) after.front().condition.clear(); // whatever the outcome
        stored_ = std::move(after);
        ++pictures_stored_;
        waiting_.clear();
    }

    Pass composed(const std::vector<WaitingStage>& living, Finish finish, const ImageRef& target) {
        std::vector<Stage> stages;
        Pass pass;
        pass.inputs.push_back({"color", the_picture, false});
        for (const WaitingStage& waiting : living) {
            stages.push_back(waiting.stage);
            pass.effects.push_back(waiting.stage.entry);
            pass.inputs.insert(pass.inputs.end(), waiting.inputs.begin(), waiting.inputs.end());
        }
        std::vector<std::string> parts = pass.effects;
        if (finish.encoding != Encoding::none) parts.emplace_back("output");
        if (parts.empty()) parts.emplace_back("copy");
        pass.name = fmt::format("{}", fmt::join(parts, "+"));
        const Numbers numbers = numbers_of(facts_.width, facts_.height);
        const std::string form =
            fmt::format("compose {} {}", static_cast<int>(finish.encoding), finish.divide_by_alpha);
        pass.program =
            program(stages, form, numbers, [&] { return assemble_compose(stages, finish, numbers); });
        pass.format = plan_.targets[target.index].format;
        pass.outputs = {target};
        pass.width = facts_.width;
        pass.height = facts_.height;
        pass.uniform_block = uniform_block(stages, numbers);
        return pass;
    }

    /// The picture in one image that is known beforehand: where the frame may leave it in others, it is copied.
    ImageRef one_image() {
        if (stored_.size() == 1) return stored_.front().image;
        const Alternative last = stored_.front();
        stored_.erase(stored_.begin());
        emit(composed({}, Finish{}, last.image), {});
        return last.image;
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

    Finish final_finish() const {
        if (options_.output == Output::linear) return {};
        const bool nothing_ran =
            std::all_of(plan_.effects.begin(), plan_.effects.end(),
                        [](const PlannedEffect& e) { return e.status == EffectStatus::skipped; });
        // Dithering codes that were 8 bits to begin with would only change them.
        const bool keeps_codes = facts_.color_is_8bit && nothing_ran;
        return {keeps_codes ? Encoding::srgb : Encoding::srgb_dithered, options_.divide_by_alpha};
    }

    void warn_about_order(const ChainEntry& entry) {
        const EffectStage stage = entry.effect->stage;
        if (stage != EffectStage::display && !display_since_.empty()) {
            plan_.warnings.push_back(
                fmt::format("{} works on scene-linear light, but stands after {}, which made it "
                            "display light",
                            entry.name, display_since_));
        }
        if (stage == EffectStage::scene_to_display) {
            if (!early_display_.empty()) {
                plan_.warnings.push_back(
                    fmt::format("{} belongs after {}, which makes the display light that it "
                                "works on",
                                early_display_, entry.name));
            }
            display_since_ = entry.name;
        } else if (stage == EffectStage::display && display_since_.empty()) {
            early_display_ = entry.name;
        }
    }

    const SceneFacts& facts_;
    const PlanOptions& options_;
    Skip skip_;
    Programs& programs_;
    FrameBlock frame_;
    Plan plan_;
    std::vector<Alternative> stored_;
    int pictures_stored_ = 0;             ///< tells one stored picture from the next
    std::map<std::string, int> censuses_; ///< slots by what was counted
    std::vector<WaitingStage> waiting_;
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
    Walk::Programs programs;
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
