#include <plan/draft.hpp>

#include <plan/condition.hpp>

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

namespace postfx {

PlanDraft::PlanDraft(const SceneFacts& facts, const PlanOptions& options, KnownPrograms& programs,
                     std::vector<std::string> warnings)
    : facts_(facts), options_(options), programs_(programs),
      frame_(frame_block(facts.width, facts.height, facts.camera)) {
    plan_.warnings = std::move(warnings);
    plan_.width = facts.width;
    plan_.height = facts.height;
    picture_ = {{attachment("color"), {}}};
}

ImageRef PlanDraft::attachment(const std::string& name) {
    std::vector<std::string>& names = plan_.attachments;
    const auto index = std::find(names.begin(), names.end(), name) - names.begin();
    if (index == std::ssize(names)) names.push_back(name);
    return {ImageRef::Kind::attachment, static_cast<int>(index)};
}

ImageRef PlanDraft::new_target(int width, int height, Format format) {
    plan_.targets.push_back({width, height, format});
    return {ImageRef::Kind::target, static_cast<int>(plan_.targets.size()) - 1};
}

Numbers PlanDraft::numbers_of(int width, int height) const {
    return {width, height, options_.fold, options_.count_taps, frame_};
}

std::shared_ptr<const ProgramSource> PlanDraft::program(const std::vector<Stage>& stages,
                                                        const std::string& form, const Numbers& numbers,
                                                        const std::function<ProgramSource()>& make) {
    KnownProgram& found = programs_[program_key(stages, form, numbers)];
    if (!found.source) {
        found.source = std::make_shared<const ProgramSource>(make());
        for (const Stage& stage : stages)
            found.effects.push_back(stage.effect);
    }
    return found.source;
}

void PlanDraft::emit(const Pass& pass, const Condition& condition) {
    const auto is_picture = [](const PassInput& input) { return input.image == the_picture; };
    if (std::none_of(pass.inputs.begin(), pass.inputs.end(), is_picture)) {
        plan_.passes.push_back(pass);
        plan_.passes.back().condition = condition;
        return;
    }
    for (const Alternative& alternative : picture_) {
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

void PlanDraft::store_picture(std::vector<Alternative> picture) {
    picture_ = std::move(picture);
    ++pictures_stored_;
}

} // namespace postfx
