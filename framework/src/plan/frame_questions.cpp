#include <plan/frame_questions.hpp>

#include <fmt/format.h>

#include <utility>
#include <vector>

namespace postfx {

void FrameQuestions::ask(const ChainEntry& entry, const Recording& recording) {
    const RecordedDecision& asked = *recording.decision;
    std::vector<CensusInput> censuses;
    for (const RecordedInput& input : asked.pass.inputs)
        censuses.push_back(census_of(recording.images[input.image]));
    const int decision = static_cast<int>(draft_.plan().decisions.size());
    draft_.plan().decisions.push_back(asked.decision);
    draft_.effect().decision = decision;

    const Stage stage = make_stage(entry, asked.pass);
    const Numbers numbers = draft_.numbers();
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
    pass.program = draft_.program({stage}, form, numbers,
                                  [&] { return assemble_decision(stage, decision, censuses, numbers); });
    pass.uniform_block = uniform_block({stage}, numbers);
    pass.width = pass.height = 1;
    draft_.plan().passes.push_back(std::move(pass));
}

/// Count every image once, however many ask.
CensusInput FrameQuestions::census_of(const RecordedImage& image) {
    const bool of_picture = image.kind == RecordedImage::Kind::color;
    const bool depth = image.attachment == "depth";
    const std::string name =
        of_picture ? fmt::format("picture {}", draft_.pictures_stored()) : image.attachment;
    const auto [found, is_new] = censuses_.try_emplace(name, draft_.plan().censuses);
    if (!is_new) return {found->second, depth};
    const Numbers numbers = draft_.numbers();
    Pass pass;
    pass.kind = PassKind::census;
    pass.slot = draft_.plan().censuses++;
    pass.name = fmt::format("census of {}", of_picture ? "the picture" : name);
    pass.program = draft_.program({}, depth ? "census depth" : "census", numbers,
                                  [&] { return assemble_census(depth, numbers); });
    pass.uniform_block = uniform_block({}, numbers);
    pass.width = draft_.facts().width;
    pass.height = draft_.facts().height;
    pass.inputs = {{name, of_picture ? the_picture : draft_.attachment(image.attachment), false}};
    draft_.emit(pass, {});
    return {pass.slot, depth};
}

} // namespace postfx
