// Studies one effect after the other. It knows effects, truths and metrics only as they are registered. [GL thread]
#pragma once

#include "pictures.hpp"
#include "study/findings.hpp"
#include "study/spec.hpp"
#include "times.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace postfx::host::study {

struct StudyOptions {
    std::optional<Size> picture;     ///< that is compared with truths, for all effects; else as the spec says
    std::vector<Size> time_sizes;    ///< the first is the one that is told; others tell how time grows
    std::vector<std::string> scenes; ///< empty: those of the spec
    TruthOptions truths;
    TimeOptions times;
    bool growth = true;
    double growth_seconds = 1; ///< a level that takes longer for one draw is left out of its growth
};

/// Of pictures that are compared with truths where nobody says anything else.
inline constexpr Size usual_picture{480, 270};

class Study {
public:
    Study(const Catalog& catalog, Spec spec, StudyOptions options);

    /// Everything of one effect. Throws Error, or Interrupted when it was asked to stop.
    EffectFindings run(const EffectInfo& effect);

    /// Of chains without effects, from all that was measured so far.
    TimeCurve base() const;

private:
    Size size_for(const EffectSpec& spec) const;
    std::shared_ptr<StudyScene> scene(const std::string& name);
    void find_errors(EffectFindings& findings, const std::vector<ChainEntry>& entries,
                     const std::string& judged_by);
    void find_steps(EffectFindings& findings);
    void find_times(EffectFindings& findings, const EffectInfo& effect,
                    const std::vector<ChainEntry>& entries);

    const Catalog& catalog_;
    Spec spec_;
    StudyOptions options_;
    std::map<std::string, std::shared_ptr<StudyScene>> scenes_;
    std::vector<std::pair<double, double>> base_; ///< megapixels, ms
    /// Of the effect at hand: by scene, pictures by level too.
    std::vector<std::shared_ptr<StudyScene>> at_hand_;
    std::vector<std::unique_ptr<View>> views_;
    std::vector<std::vector<LevelPicture>> pictures_;
};

} // namespace postfx::host::study
