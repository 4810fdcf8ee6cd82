// A plan while it is made: what decisions, fusion and passes of effects are added to.
#pragma once

#include <plan/assemble.hpp>

#include <postfx/plan.hpp>

#include <functional>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

namespace postfx {

/// Stands for the picture so far, whichever image it is in.
inline constexpr ImageRef the_picture{};

/// One of the images that the picture so far may be in, by what the frame decided.
struct Alternative {
    ImageRef image;
    Condition condition;
};

/// A program by what it is made of. Its effects are kept, so that their addresses, which are part of the key, are not
/// given to others.
struct KnownProgram {
    std::shared_ptr<const ProgramSource> source;
    std::vector<EffectPtr> effects;
};
using KnownPrograms = std::unordered_map<std::string, KnownProgram>;

class PlanDraft {
public:
    /// All of them have to stay.
    PlanDraft(const SceneFacts& facts, const PlanOptions& options, KnownPrograms& programs,
              std::vector<std::string> warnings);

    const SceneFacts& facts() const { return facts_; }
    const PlanOptions& options() const { return options_; }
    /// What stands so far.
    Plan& plan() { return plan_; }
    const Plan& plan() const { return plan_; }
    /// The effect that is being added.
    PlannedEffect& effect() { return plan_.effects.back(); }

    ImageRef attachment(const std::string& name);
    ImageRef new_target(int width, int height, Format format);

    /// For a target of that size; without one, for the picture's.
    Numbers numbers_of(int width, int height) const;
    Numbers numbers() const { return numbers_of(facts_.width, facts_.height); }

    /// Made only if it is not known. `form`: what of it is not in stages and numbers.
    std::shared_ptr<const ProgramSource> program(const std::vector<Stage>& stages, const std::string& form,
                                                 const Numbers& numbers,
                                                 const std::function<ProgramSource()>& make);

    /// Append the pass, drawn under `condition`: once for each image that the picture may be in, if it reads that.
    void emit(const Pass& pass, const Condition& condition);

    /// The picture so far: one image, or, behind effects that the frame decides on, alternatives of which exactly one
    /// holds.
    const std::vector<Alternative>& picture() const { return picture_; }
    void store_picture(std::vector<Alternative> picture);
    /// Tells one stored picture from the next.
    int pictures_stored() const { return pictures_stored_; }

private:
    const SceneFacts& facts_;
    const PlanOptions& options_;
    KnownPrograms& programs_;
    FrameBlock frame_;
    Plan plan_;
    std::vector<Alternative> picture_;
    int pictures_stored_ = 0;
};

} // namespace postfx
