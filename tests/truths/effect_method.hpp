// What metrics measure: effects of this build, and functions.
#pragma once

#include <catch2/catch.hpp>

#include <testing.hpp>
#include <truths/metric.hpp>

#include <algorithm>
#include <functional>
#include <string>

namespace postfx::testing {

inline ChainEntry entry_of(const std::string& effect) {
    Chain chain;
    return chain.add(catalog(), effect);
}

/// One effect at one level, by OpenGL.
class EffectMethod : public host::Method {
public:
    EffectMethod(const std::string& effect, const std::string& level) : entry_(entry_of(effect)) {
        set_level(entry_, level);
    }

    const ChainEntry& entry() const override { return entry_; }
    Image64 draw(const ChainEntry& entry, const host::MethodInput& input) const override {
        Values values = {{"quality", names_of_levels(*entry.effect)[static_cast<std::size_t>(entry.level)]}};
        for (std::size_t i = 0; i < entry.values.size(); ++i) {
            const ParameterInfo& parameter = entry.effect->parameters[i];
            for (std::size_t c = 0; c < std::size_t(parameter.components()); ++c)
                values[parameter.components() == 1 ? parameter.id : parameter.id + "." + std::to_string(c)] =
                    entry.values[i][c];
        }
        const Input in{.color = input.color,
                       .attachments = input.attachments,
                       .camera = input.camera,
                       .time = input.time,
                       .frame = input.frame};
        return convert<double>(three_channels(run_effect(entry.effect->id, in, values)));
    }

private:
    ChainEntry entry_;
};

/// What a function makes of the picture.
class FunctionMethod : public host::Method {
public:
    using Function = std::function<Image64(const ChainEntry&, const host::MethodInput&)>;
    FunctionMethod(const std::string& effect, Function function)
        : entry_(entry_of(effect)), function_(std::move(function)) {}

    const ChainEntry& entry() const override { return entry_; }
    Image64 draw(const ChainEntry& entry, const host::MethodInput& input) const override {
        return function_(entry, input);
    }

private:
    ChainEntry entry_;
    Function function_;
};

inline double measure(const std::string& name, const host::Method& method) {
    for (const host::RegisteredMetric& metric : host::registered_metrics()) {
        if (metric.effect == method.entry().effect->id && metric.name == name) return metric.measure(method);
    }
    throw Error("there is no metric " + name);
}

} // namespace postfx::testing
