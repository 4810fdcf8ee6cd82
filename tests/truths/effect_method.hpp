// What metrics measure: effects of this build, and functions.
#pragma once

#include "truth_of.hpp"

#include <truths/metric.hpp>

#include <algorithm>
#include <functional>
#include <string>

namespace postfx::testing {

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

inline double value_of(const ChainEntry& entry, const std::string& parameter) {
    return entry.values[*entry.effect->find_parameter(parameter)][0];
}

inline double measure(const std::string& name, const host::Method& method) {
    for (const host::RegisteredMetric& metric : host::registered_metrics()) {
        if (metric.effect == method.entry().effect->id && metric.name == name) return metric.measure(method);
    }
    throw Error("there is no metric " + name);
}

/// The picture as it was.
inline Image64 unchanged(const ChainEntry&, const host::MethodInput& input) {
    return convert<double>(input.color);
}

/// 0.99 of the light in the channels from `first` on.
inline Image64 dimmed(const host::MethodInput& input, int first) {
    Image64 picture = convert<double>(input.color);
    for (std::size_t i = 0; i < picture.values.size(); ++i)
        picture.values[i] *= static_cast<int>(i % 3) >= first ? 0.99 : 1;
    return picture;
}

/// Every pixel from its place in picture heights from the centre, and its depth along the view axis [m], 0 without.
using PixelFunction =
    std::function<double(const ChainEntry&, const host::MethodInput&, double x, double y, double z)>;
inline FunctionMethod::Function every_pixel(const PixelFunction& pixel) {
    return [=](const ChainEntry& entry, const host::MethodInput& input) {
        const int width = input.color.width, height = input.color.height;
        const auto depth = input.attachments.find("depth");
        Image64 result(width, height, 3);
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const double z =
                    depth == input.attachments.end() ? 0 : input.camera.view_z(depth->second.at(x, y, 0));
                const double found =
                    pixel(entry, input, (x + 0.5 - 0.5 * width) / height, (y + 0.5) / height - 0.5, z);
                std::fill_n(result.pixel(x, y), 3, found);
            }
        }
        return result;
    };
}

/// Less light by that much.
inline FunctionMethod::Function spoiled(const FunctionMethod::Function& draw, double by) {
    return [=](const ChainEntry& entry, const host::MethodInput& input) {
        Image64 result = draw(entry, input);
        for (double& found : result.values)
            found -= by;
        return result;
    };
}

} // namespace postfx::testing
