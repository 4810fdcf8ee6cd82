#include "truth.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

namespace postfx::host {

namespace {

const Value& value_of(const ChainEntry& entry, std::string_view parameter) {
    const auto index = entry.effect->find_parameter(parameter);
    if (!index)
        throw Error(Place{.effect = entry.effect->id},
                    fmt::format("there is no parameter \"{}\"", parameter));
    return entry.values[*index];
}

} // namespace

double TruthRequest::value(std::string_view parameter) const {
    return value_of(entry, parameter)[0];
}

std::array<double, 3> TruthRequest::color(std::string_view parameter) const {
    const Value& value = value_of(entry, parameter);
    return {value[0], value[1], value[2]};
}

std::string TruthRequest::all_values() const {
    std::string text;
    for (std::size_t i = 0; i < entry.values.size(); ++i) {
        const Value& value = entry.values[i];
        text += fmt::format("{}{} {} {} {}", i > 0 ? ", " : "", entry.effect->parameters[i].id, value[0],
                            value[1], value[2]);
    }
    return text;
}

std::vector<RegisteredTruth>& registered_truths() {
    static std::vector<RegisteredTruth> truths;
    return truths;
}

const RegisteredTruth& find_truth(const std::string& effect, const std::string& kind) {
    std::string others, kinds;
    for (const RegisteredTruth& truth : registered_truths()) {
        if (truth.effect == effect && truth.kind == kind) return truth;
        if (truth.effect == effect) kinds += (kinds.empty() ? "" : ", ") + truth.kind;
        others += fmt::format("{}{} ({})", others.empty() ? "" : ", ", truth.effect, truth.kind);
    }
    if (!kinds.empty())
        throw Error(fmt::format("{} has no truth of kind \"{}\"; it has {}", effect, kind, kinds));
    throw Error(fmt::format("{} has no truth; there are {}", effect, others));
}

Image64 mean_of(Image64 sum, int count) {
    for (double& value : sum.values)
        value /= count;
    return sum;
}

} // namespace postfx::host
