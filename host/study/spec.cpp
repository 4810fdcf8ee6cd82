#include "spec.hpp"

#include <base/read_file.hpp>
#include <scene/yaml.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace postfx::host::study {
namespace {

constexpr std::size_t max_bytes = std::size_t{1} << 20;

/// A value as a chain file writes it; the chain's own reader checks it.
std::string value_text(const YamlValue& value) {
    if (!value.is_list()) return value.text();
    std::vector<std::string> items;
    for (const YamlValue& item : value.list())
        items.push_back(item.text());
    return fmt::format("[{}]", fmt::join(items, ", "));
}

/// "radius: 1, mode: threshold"
std::string values_text(const YamlValue& value) {
    std::vector<std::string> items;
    for (const auto& [key, item] : value.entries())
        items.push_back(fmt::format("{}: {}", key.text(), value_text(item)));
    return fmt::format("{}", fmt::join(items, ", "));
}

ChainEntry entry_with(const Catalog& catalog, const std::string& effect, const std::string& values) {
    Chain chain;
    parse_chain_entry(fmt::format("{}: {{{}}}", effect, values), "study of " + effect, catalog, chain);
    return chain.entries.at(0);
}

RadiusSpec read_radius(const YamlValue& value) {
    const YamlMap map(value, "radius", {"parameter", "per_height", "at_most", "scene", "values"});
    RadiusSpec radius;
    radius.parameter = map.at("parameter").text();
    map.read("per_height", radius.per_height, {1e-9, 1e9});
    map.read("at_most", radius.at_most, {1e-6, 10});
    map.read("scene", radius.scene);
    if (const auto values = map.find("values")) radius.values = values_text(*values);
    return radius;
}

EffectSpec read_effect(const YamlValue& value, const EffectSpec& standard, const std::string& what) {
    const YamlMap map(value, what, {"scenes", "values", "judged_by", "size", "radius"});
    EffectSpec spec = standard;
    if (const auto scenes = map.find("scenes")) {
        spec.scenes.clear();
        for (const YamlValue& scene : scenes->list())
            spec.scenes.push_back(scene.text());
    }
    if (spec.scenes.empty()) value.fail("expected at least one scene");
    if (const auto values = map.find("values")) spec.values = values_text(*values);
    map.read("size", spec.size);
    if (const auto kind = map.find("judged_by")) spec.judged_by = kind->choice({"scene", "layer"});
    if (const auto radius = map.find("radius")) spec.radius = read_radius(*radius);
    return spec;
}

} // namespace

std::filesystem::path entry_file(const EffectInfo& effect) {
    return effect.module_path.parent_path() / fmt::format("postfx_{}.study.yaml", effect.id);
}

Spec Spec::read(const std::filesystem::path& file) {
    return parse(read_file(file, max_bytes, "a study"), input_name(file));
}

Spec Spec::parse(const std::string& yaml, const std::string& origin) {
    const YamlMap map(parse_yaml(yaml, origin), "the study", {"default", "effects"});
    Spec spec;
    spec.default_ = read_effect(map.at("default"), {}, "default");
    if (const auto effects = map.find("effects")) {
        for (const auto& [key, value] : effects->entries())
            spec.effects_.emplace(key.text(), read_effect(value, spec.default_, key.text()));
    }
    return spec;
}

EffectSpec Spec::of(const EffectInfo& effect) const {
    if (const auto found = effects_.find(effect.id); found != effects_.end()) return found->second;
    const std::filesystem::path own = entry_file(effect);
    if (!std::filesystem::exists(own)) return default_;
    return read_effect(parse_yaml(read_file(own, max_bytes, "a study"), own.string()), default_,
                       "the study of " + effect.id);
}

ChainEntry entry_of(const Catalog& catalog, const std::string& effect, const EffectSpec& spec) {
    return entry_with(catalog, effect, spec.values);
}

ChainEntry growing_entry_of(const Catalog& catalog, const std::string& effect, const EffectSpec& spec) {
    if (!spec.radius || spec.radius->values.empty()) return entry_of(catalog, effect, spec);
    const char* comma = spec.values.empty() ? "" : ", ";
    return entry_with(catalog, effect, spec.values + comma + spec.radius->values);
}

std::optional<double> value_for_radius(const RadiusSpec& radius, const EffectInfo& effect, double pixels,
                                       int picture_height) {
    const auto index = effect.find_parameter(radius.parameter);
    if (!index) {
        throw Error(
            Place{.effect = effect.id},
            fmt::format("the study's radius is of \"{}\", which it has no parameter of", radius.parameter));
    }
    const ParameterInfo& parameter = effect.parameters[*index];
    const double share = pixels / picture_height, value = share * radius.per_height;
    if (share > radius.at_most || value < parameter.minimum || value > parameter.maximum) return std::nullopt;
    return value;
}

} // namespace postfx::host::study
