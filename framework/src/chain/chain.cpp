#include <postfx/chain.hpp>

#include "base/words.hpp"
#include "chain/read_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace postfx {
namespace {

constexpr Words<4> skip_words = {"nothing", "exact", "code", "visible"};

bool is_stepped(ParameterKind kind) {
    return kind == ParameterKind::integer || kind == ParameterKind::toggle || kind == ParameterKind::choice;
}

} // namespace

std::string_view skip_word(Skip skip) {
    return word_among(skip_words, skip);
}

std::optional<Skip> skip_by_word(std::string_view word) {
    return value_among<Skip>(skip_words, word);
}

std::string_view budget_word(Budget::Of of) {
    return of == Budget::Of::ms ? "ms" : "error";
}

bool ChainEntry::set(std::string_view parameter, double value) {
    const auto index = effect->find_parameter(parameter);
    if (!index) throw Error(unknown_parameter(*effect, parameter));
    if (std::isnan(value)) return false;

    const ParameterInfo& info = effect->parameters[*index];
    const double clamped = std::clamp(value, info.minimum, info.maximum);
    const double stored = is_stepped(info.kind) ? std::round(clamped) : clamped;
    const auto components = static_cast<std::size_t>(info.components());
    std::fill_n(values.at(*index).begin(), components, stored);
    return clamped == value;
}

ChainEntry& Chain::add(const Catalog& catalog, std::string_view effect_id) {
    const EffectPtr effect = catalog.find(effect_id);
    if (!effect) {
        const std::vector<std::string> known = catalog.ids();
        throw Error(
            fmt::format("no effect {}{}", quote(effect_id),
                        known.empty() ? "; no plugins were found" : nearest_or_all(effect_id, known)));
    }
    std::string name = effect->id;
    for (int n = 2; find(name) != nullptr; ++n)
        name = fmt::format("{}_{}", effect->id, n);
    return entries.emplace_back(
        ChainEntry{effect, name, true, effect->default_level, false, effect->default_values()});
}

ChainEntry* Chain::find(std::string_view name) {
    const auto found = std::find_if(entries.begin(), entries.end(),
                                    [name](const ChainEntry& entry) { return entry.name == name; });
    return found == entries.end() ? nullptr : &*found;
}

} // namespace postfx
