#include "tables.hpp"

#include <fmt/format.h>

#include <cmath>

namespace postfx::host::study {
namespace {

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
    std::string result = "\"";
    for (const char letter : text)
        result += letter == '"' ? "\"\"" : std::string(1, letter);
    return result + "\"";
}

class Row {
public:
    Row& add(const std::string& text) {
        if (!line_.empty()) line_ += ',';
        line_ += quoted(text);
        return *this;
    }
    Row& add(double value) {
        line_ += ',';
        if (std::isfinite(value)) line_ += fmt::format("{:.6g}", value);
        return *this;
    }
    Row& add(const std::optional<double>& value) { return add(value.value_or(std::nan(""))); }
    Row& add(const Cost& cost) {
        return add(cost.ms.median)
            .add(cost.ms.p10)
            .add(cost.ms.p90)
            .add(cost.copies.median)
            .add(static_cast<double>(cost.ms.rounds));
    }
    std::string line() const { return line_ + "\n"; }

private:
    std::string line_;
};

constexpr const char* truth_kinds[] = {"scene", "layer"};

void add_errors(Row& row, const SceneFindings& scene, const LevelOnScene& level) {
    for (const char* kind : truth_kinds) {
        const TruthFacts* truth = scene.find_truth(kind);
        const auto error = level.errors.find(kind);
        const PictureError unknown{std::nan(""), std::nan("")};
        const PictureError& found = error == level.errors.end() ? unknown : error->second;
        row.add(found.relative_rmse).add(truth ? truth->own_error : std::nan("")).add(found.flip);
    }
}

} // namespace

std::string findings_csv(const Findings& findings) {
    const Conditions& conditions = findings.conditions;
    std::string text = "effect,scene,level";
    for (const char* kind : truth_kinds)
        text += fmt::format(",relative_rmse_{0},own_error_{0},flip_{0}", kind);
    for (const std::string& size : conditions.time_sizes)
        text += fmt::format(",ms_{0},ms_p10_{0},ms_p90_{0},copies_{0},rounds_{0}", size);
    text += ",passes,bytes_written_per_pixel,bytes_read_per_pixel,taps_per_pixel,error,dominated_by,step_to_"
            "next,skipped\n";
    for (const EffectFindings& effect : findings.effects) {
        for (std::size_t s = 0; s < effect.scenes.size(); ++s) {
            for (const Level& level : effect.levels) {
                Row row;
                row.add(effect.id).add(effect.scenes[s].name).add(level.id);
                add_errors(row, effect.scenes[s], level.scenes[s]);
                for (const Cost& cost : level.scenes[s].costs)
                    row.add(cost);
                row.add(static_cast<double>(level.passes)).add(level.bytes_written).add(level.bytes_read);
                row.add(level.scenes[s].taps)
                    .add(level.error)
                    .add(level.dominated_by)
                    .add(level.step_to_next);
                text += row.add(level.scenes[s].skipped).line();
            }
        }
    }
    return text;
}

std::string metrics_csv(const Findings& findings) {
    std::string text = "effect,level,metric,unit,value\n";
    for (const EffectFindings& effect : findings.effects) {
        for (const Level& level : effect.levels) {
            for (std::size_t m = 0; m < effect.metrics.size(); ++m) {
                Row row;
                row.add(effect.id).add(level.id).add(effect.metrics[m].name).add(effect.metrics[m].unit);
                text += row.add(level.metrics[m]).line();
            }
        }
    }
    return text;
}

std::string growth_csv(const Findings& findings) {
    std::string text = "effect,over,scene,level,at,ms,error,time_exponent,error_exponent\n";
    for (const EffectFindings& effect : findings.effects) {
        for (const Growth& growth : effect.growth) {
            for (const GrowthCurve& curve : growth.curves) {
                for (const GrowthCurve::Point& point : curve.points) {
                    Row row;
                    row.add(effect.id).add(growth.over).add(growth.scene).add(curve.level);
                    row.add(point.at).add(point.ms).add(point.error);
                    text += row.add(curve.time_exponent).add(curve.error_exponent).line();
                }
            }
        }
    }
    return text;
}

} // namespace postfx::host::study
