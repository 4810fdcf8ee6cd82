#include <plan/fusion.hpp>

#include <plan/condition.hpp>
#include <plan/record.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace postfx {
namespace {

constexpr std::size_t most_uniform_bytes = 16384; // of a block; GL 4.5 promises no more

/// Programs double with each: one with the effect's code, one without.
constexpr int most_decisions_in_a_pass = 3;

} // namespace

/// Why the function can't join those that wait; empty when it can.
std::string Fusion::why_apart(const WaitingStage& stage) const {
    std::string apart = draft_.options().fuse || waiting_.empty() ? "" : "fusion is off";
    std::size_t inputs = 1 + stage.inputs.size();
    std::size_t bytes = block_head_bytes + stage.bytes;
    for (const WaitingStage& other : waiting_) {
        if (apart.empty()) apart = why_not_together(other.stage, stage.stage);
        inputs += other.inputs.size();
        bytes += other.bytes;
    }
    if (apart.empty() && inputs > most_pass_inputs) {
        apart = fmt::format("{} would need {} textures in one pass, {} are sure", stage.stage.entry, inputs,
                            most_pass_inputs);
    }
    if (apart.empty() && bytes > most_uniform_bytes) {
        apart = fmt::format("{} would need {} bytes of uniforms in one pass, {} are sure", stage.stage.entry,
                            bytes, most_uniform_bytes);
    }
    const auto decisions = std::count_if(waiting_.begin(), waiting_.end(),
                                         [](const WaitingStage& other) { return other.decision >= 0; });
    if (apart.empty() && stage.decision >= 0 && decisions == most_decisions_in_a_pass) {
        apart = fmt::format("the frame would decide on more than {} effects of one pass", decisions);
    }
    return apart;
}

void Fusion::wait(WaitingStage stage) {
    const std::string apart = why_apart(stage);
    if (!apart.empty() && !waiting_.empty()) flush(Finish{}, apart);
    waiting_.push_back(std::move(stage));
}

void Fusion::flush(Finish finish, const std::string& because) {
    explain(because);
    std::vector<int> decisions;
    for (const WaitingStage& waiting : waiting_) {
        if (waiting.decision >= 0) decisions.push_back(waiting.decision);
    }
    const Format format = finish.encoding == Encoding::none ? draft_.options().working_format : Format::rgba8;
    const ImageRef target = draft_.new_target(draft_.facts().width, draft_.facts().height, format);
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
            for (const Alternative& before : draft_.picture()) {
                if (const auto holding = both(condition, before.condition))
                    after.push_back({before.image, *holding});
            }
            continue;
        }
        draft_.emit(composed(living, finish, target), condition);
        if (!decisions.empty()) after.front().condition.push_back(term);
    }
    if (after.size() == 1) after.front().condition.clear(); // whatever the outcome
    draft_.store_picture(std::move(after));
    waiting_.clear();
}

Pass Fusion::composed(const std::vector<WaitingStage>& living, Finish finish, const ImageRef& target) {
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
    const Numbers numbers = draft_.numbers();
    const std::string form =
        fmt::format("compose {} {}", static_cast<int>(finish.encoding), finish.divide_by_alpha);
    pass.program =
        draft_.program(stages, form, numbers, [&] { return assemble_compose(stages, finish, numbers); });
    pass.format = draft_.plan().targets[target.index].format;
    pass.outputs = {target};
    pass.width = draft_.facts().width;
    pass.height = draft_.facts().height;
    pass.uniform_block = uniform_block(stages, numbers);
    return pass;
}

ImageRef Fusion::one_image() {
    std::vector<Alternative> others = draft_.picture();
    const ImageRef image = others.front().image;
    if (others.size() == 1) return image;
    others.erase(others.begin());
    draft_.store_picture(std::move(others));
    draft_.emit(composed({}, Finish{}, image), {});
    return image;
}

void Fusion::explain(const std::string& because) {
    for (const WaitingStage& waiting : waiting_) {
        PlannedEffect& planned = draft_.plan().effects[waiting.effect];
        std::vector<std::string> others;
        for (const WaitingStage& other : waiting_) {
            if (other.effect != waiting.effect) others.push_back(other.stage.entry);
        }
        if (!others.empty()) planned.status = EffectStatus::fused;
        planned.reason = others.empty()
                             ? fmt::format("a pass of its own; after it {}", because)
                             : fmt::format("one pass with {}; after it {}", fmt::join(others, ", "), because);
    }
}

} // namespace postfx
