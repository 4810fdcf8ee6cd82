// What of each effect is studied: what configs/study.yaml, and study.yaml beside the effect, say.
#pragma once

#include <postfx/chain.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace postfx::host::study {

/// What a radius in pixels is for a parameter: value = pixels / height of the picture * per_height.
struct RadiusSpec {
    std::string parameter;
    double per_height = 1;
    double at_most = 1; ///< share of the height that a radius can be, by the effect's other limits
    std::string scene;  ///< that it holds for; "" = any
    std::string values; ///< that the effect has meanwhile, beside its own; as EffectSpec's
};

struct EffectSpec {
    std::vector<std::string> scenes; ///< names; never empty
    std::string values;              ///< as in a chain file, without braces: "radius: 1, mode: threshold"
    std::string judged_by;           ///< kind of truth; "" = "scene" if there is one, else "layer"
    std::string size; ///< of pictures that are compared with truths, "1280x720"; "" = as for all
    std::optional<RadiusSpec> radius;
};

/// Where an effect's own entry is, if it has one: beside its module.
std::filesystem::path entry_file(const EffectInfo& effect);

class Spec {
public:
    /// Throws Error with file:line:column.
    static Spec read(const std::filesystem::path& file);
    static Spec parse(const std::string& yaml, const std::string& origin);

    /// What the file says of the effect, else what its own entry_file() says, else the file's `default:`. Throws Error
    /// with file:line:column.
    EffectSpec of(const EffectInfo& effect) const;

private:
    EffectSpec default_;
    std::map<std::string, EffectSpec> effects_;
};

/// The effect with the spec's values, at its default level. Throws Error for values that it does not have.
ChainEntry entry_of(const Catalog& catalog, const std::string& effect, const EffectSpec& spec);
/// The same with the values that it has while its radius grows.
ChainEntry growing_entry_of(const Catalog& catalog, const std::string& effect, const EffectSpec& spec);

/// The entry's value of the radius's parameter for so many pixels; nothing when it would be out of its range.
std::optional<double> value_for_radius(const RadiusSpec& radius, const EffectInfo& effect, double pixels,
                                       int picture_height);

} // namespace postfx::host::study
