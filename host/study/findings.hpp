// What a study found, as plain data: nothing here measures, draws or writes.
#pragma once

#include <postfx/curves.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace postfx::host::study {

/// Samples of one quantity: one per round.
struct Spread {
    double median = 0, p10 = 0, p90 = 0;
    int rounds = 0;

    /// Standard error of the median, from the spread as if it were normal; a fifth of the median below three rounds.
    double uncertainty() const;
};

/// Of many; empty: all 0.
Spread spread_of(const std::vector<double>& samples);

/// How far a picture is from a truth; infinity where light is not finite.
struct PictureError {
    double relative_rmse = 0; ///< as RelativeError's
    double flip = 0;          ///< LDR-FLIP, mean over pixels, of the picture as SceneFindings::shown says
};

/// A truth of one scene.
struct TruthFacts {
    std::string kind; ///< "scene" or "layer"
    std::string description;
    int samples = 0;
    double own_error = 0;    ///< relative, as TruthResult's
    bool statistics = false; ///< only its statistics are a picture's too
};

/// At one size: what an effect adds to a chain.
struct Cost {
    int width = 0, height = 0;
    Spread ms, copies;
    double megapixels() const { return 1e-6 * width * height; }
};

/// A level, on one scene.
struct LevelOnScene {
    std::map<std::string, PictureError> errors; ///< by the truth's kind
    std::vector<Cost> costs;                    ///< as Conditions::time_sizes
    std::string skipped;                        ///< why the effect did not run there; "" if it did
    /// Texture reads per pixel of the picture that the effect adds to a chain, counted while it drew the first of
    /// Conditions::time_sizes; none: they can't be counted.
    std::optional<double> taps;
};

/// A level of an effect.
struct Level {
    std::string id; ///< "" when the effect has but one quality
    std::string help;
    std::vector<LevelOnScene> scenes; ///< as EffectFindings::scenes
    std::vector<double> metrics;      ///< as EffectFindings::metrics; NaN: could not be measured
    int passes = 0;                   ///< that the effect adds; at most, as all that follow
    double bytes_written = 0;         ///< per pixel of the picture
    double bytes_read = 0;            ///< per pixel of the picture, if every texel that is read is read once

    // Concluded from these:
    std::optional<double> error; ///< mean over scenes; none without a truth
    std::optional<double> taps; ///< as LevelOnScene's, mean over scenes as times are; none where one lacks it
    Spread ms;                  ///< at the first of Conditions::time_sizes; mean over scenes
    TimeCurve time;
    std::string dominated_by; ///< id of one that is no worse in one and better in the other; "" = none
    bool on_hull = false;     ///< of the convex hull in log error over log time
    double step_to_next = 0;  ///< FLIP to the next level of the curve, mean over scenes; 0 for the last

    /// "medium", or "its only level".
    std::string name() const { return id.empty() ? "its only level" : id; }
};

struct MetricFacts {
    std::string name, unit, help;
    bool stands_for_error = false;
};

struct SceneFindings {
    std::string name, description;
    std::vector<TruthFacts> truths;
    std::map<std::string, std::string> no_truth; ///< by kind, why there is none
    /// Relative RMSE of the truth of kind "layer" from that of kind "scene": what the effect's inputs do not tell.
    std::optional<double> inputs_error;

    const TruthFacts* find_truth(const std::string& kind) const;
};

/// How a level grows with something.
struct GrowthCurve {
    struct Point {
        double at = 0; ///< pixels of radius, or megapixels of the picture
        double ms = 0;
        std::optional<double> error; ///< relative RMSE from the truth at that radius
    };
    std::string level;
    std::vector<Point> points;
    std::optional<double> time_exponent,
        error_exponent; ///< of a power law; none when there is nothing to fit
};

struct Growth {
    std::string over;       ///< "radius" or "pixels"
    std::string scene;      ///< name
    std::string truth;      ///< kind that errors are from; "" = none
    std::string conditions; ///< in words: what was varied, at which size
    std::vector<GrowthCurve> curves;
    std::vector<std::string> left_out; ///< levels that were too slow
};

/// A picture of the page: 8-bit sRGB codes, bottom row first.
struct Thumbnail {
    std::string name; ///< "given", "truth", or the level that it shows
    int width = 0, height = 0;
    std::vector<std::uint8_t> codes;
};

struct EffectFindings {
    std::string id, help, stage;
    std::string values;       ///< that differ from the defaults, as in a chain file; "" = none
    std::string picture_size; ///< of pictures that were compared with truths, "480x270"
    std::string judged_by;    ///< kind of the truth that Level::error is from; "" = no truth of pixels
    std::string error_is;     ///< in words
    std::vector<MetricFacts> metrics;
    std::vector<SceneFindings> scenes;
    std::vector<Level> levels; ///< in the effect's order
    std::vector<Growth> growth;
    std::vector<Thumbnail> thumbnails; ///< of the first scene
    double heat_white = 0;             ///< FLIP that is white in differences; 0: levels' own pictures instead
    std::vector<std::string> notes;    ///< what could not be measured, and why
    double seconds = 0;                ///< that the study of it took

    /// The truth's own error where levels are judged, mean over scenes; 0 without one.
    double own_error() const;
    /// SceneFindings::inputs_error, mean over scenes; none where any lacks it.
    std::optional<double> inputs_error() const;
    const Level* find(const std::string& id) const;
};

/// What did not come to an end.
struct Failure {
    std::string effect, message;
};

struct Conditions {
    std::string program; ///< version and commit
    std::string command, device, driver, clock;
    std::vector<std::string> time_sizes;
    double pixels_per_degree = 0;
    std::string working_format;
};

struct Findings {
    Conditions conditions;
    TimeCurve base; ///< of a chain without effects
    std::vector<EffectFindings> effects;
    std::vector<Failure> failures;
};

/// The id of the level that shows how it is usually done.
inline constexpr const char* classic_level = "classic";

} // namespace postfx::host::study
