// Reports and plans as JSON.
#include <postfx/report.hpp>

#include <nlohmann/json.hpp>

namespace postfx {
namespace {

template<class Value>
nlohmann::ordered_json optional_json(const std::optional<Value>& value) {
    return value ? nlohmann::ordered_json(*value) : nlohmann::ordered_json(nullptr);
}

/// "" of an effect that is not skipped, as the kind is.
std::string_view moment_text(const PlannedEffect& effect) {
    return effect.moment ? moment_word(*effect.moment) : "";
}

std::string_view kind_text(const PlannedEffect& effect) {
    return effect.kind ? skip_kind_word(*effect.kind) : "";
}

nlohmann::ordered_json json_of(const Report& report) {
    nlohmann::ordered_json json;
    json["effects"] = nlohmann::ordered_json::array();
    for (const PlannedEffect& effect : report.effects) {
        json["effects"].push_back({{"id", effect.id},
                                   {"name", effect.name},
                                   {"status", status_name(effect.status)},
                                   {"moment", moment_text(effect)},
                                   {"kind", kind_text(effect)},
                                   {"reason", effect.reason}});
    }
    json["passes"] = nlohmann::ordered_json::array();
    for (const PassReport& pass : report.passes) {
        json["passes"].push_back({{"name", pass.name},
                                  {"effects", pass.effects},
                                  {"width", pass.width},
                                  {"height", pass.height},
                                  {"format", pass.format},
                                  {"reads", pass.reads},
                                  {"condition", pass.condition},
                                  {"drawn", optional_json(pass.drawn)},
                                  {"tiles", pass.tiles},
                                  {"tiles_drawn", optional_json(pass.tiles_drawn)},
                                  {"taps", optional_json(pass.taps)},
                                  {"cpu_ms", optional_json(pass.cpu_ms)},
                                  {"wall_ms", optional_json(pass.wall_ms)},
                                  {"gpu_ms", optional_json(pass.gpu_ms)}});
    }
    json["clock"] = report.clock;
    json["texture_bytes"] = report.texture_bytes;
    json["programs"] = nullptr;
    if (report.programs) {
        json["programs"] = {{"all", report.programs->all},
                            {"compiled", report.programs->compiled},
                            {"warmed", report.programs->warmed}};
    }
    json["warnings"] = report.warnings;
    json["nonfinite"] = nullptr;
    if (report.nonfinite) {
        json["nonfinite"] = nlohmann::ordered_json::array();
        for (const NonfiniteImage& image : *report.nonfinite) {
            json["nonfinite"].push_back({{"name", image.name},
                                         {"pixels", image.pixels},
                                         {"x", image.x},
                                         {"y", image.y},
                                         {"made_here", image.made_here}});
        }
    }
    return json;
}

} // namespace

std::string report_json(const Report& report) {
    return json_of(report).dump(2);
}

std::string plan_json(const Plan& plan, const std::string& clock) {
    Report report = describe(plan);
    report.clock = clock;
    nlohmann::ordered_json json = json_of(report);
    json["attachments"] = plan.attachments;
    return json.dump(2);
}

} // namespace postfx
