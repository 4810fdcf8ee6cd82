// What is asked of each frame: censuses of images, and decisions by them.
#pragma once

#include <plan/draft.hpp>
#include <plan/record.hpp>

#include <map>
#include <string>

namespace postfx {

/// Adds passes that count and decide to the draft.
class FrameQuestions {
public:
    explicit FrameQuestions(PlanDraft& draft) : draft_(draft) {}

    /// Can one more be asked? If not, the effect runs in every frame.
    bool has_room() const { return draft_.plan().decisions.size() < max_decisions; }
    /// What the effect that is being added asks; the picture so far has to be stored if it asks of that.
    void ask(const ChainEntry& entry, const Recording& recording);

private:
    CensusInput census_of(const RecordedImage& image);

    PlanDraft& draft_;
    std::map<std::string, int> censuses_; ///< slots by what was counted
};

} // namespace postfx
