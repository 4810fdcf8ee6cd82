// Pictures that levels make, and how far they are from truths. [GL thread]
#pragma once

#include "study/findings.hpp"
#include "truths/metric.hpp"
#include "truths/truth_run.hpp"
#include "view.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace postfx::host::study {

/// What came out of one level.
struct LevelPicture {
    Image64 light;       ///< 3 channels, of the chain's own range
    std::string skipped; ///< why the effect did not run; "" if it did
};
LevelPicture picture_of(const ChainEntry& entry, const View& view);

/// A truth that was summed up.
struct SummedTruth {
    TruthFacts facts;
    Image64 picture;
};

/// All truths that there are of an effect in a view.
struct Truths {
    std::vector<SummedTruth> summed;
    std::map<std::string, std::string> missing; ///< by kind, why there is none of this view
    const SummedTruth* find(const std::string& kind) const;
};

struct TruthOptions {
    std::filesystem::path store;
    int samples = 0;  ///< 0: each truth's own default
    double share = 1; ///< of the default, where samples are not given
};

/// The kinds of truth that are registered for an effect.
std::vector<const RegisteredTruth*> truths_of(const std::string& effect);

/// Sums are kept in the store and taken up from there. Throws Interrupted.
Truths sum_up_truths(const std::vector<const RegisteredTruth*>& registered, const Scene& scene,
                     const View& view, const ChainEntry& entry, const TruthOptions& options);

PictureError error_of(const Image64& picture, const Image64& truth, const View& view);
/// LDR-FLIP per pixel of what a viewer sees, 1 channel.
Image flip_map(const Image64& picture, const Image64& truth, const View& view);
double mean_of(const Image& map);

/// The effect's registered metrics of one level; NaN where one can't be measured, with the reason in `notes`.
std::vector<double> measure_metrics(const std::vector<MetricFacts>& metrics, const ChainEntry& entry,
                                    std::vector<std::string>& notes);
std::vector<MetricFacts> metrics_of(const std::string& effect);

} // namespace postfx::host::study
