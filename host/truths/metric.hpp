// What is measured of an effect besides its distance from a truth: on inputs of which it is known what ought to come
// out. Like truths, metrics share nothing with the effect.
#pragma once

#include <postfx/camera.hpp>
#include <postfx/chain.hpp>
#include <postfx/image.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace postfx::host {

/// What goes into the effect.
struct MethodInput {
    Image color;                                   ///< 3 or 4 channels, scene-linear
    std::map<std::string, Image> attachments = {}; ///< "depth" (1 channel, raw samples), "normal" (3), ...
    Camera camera = {};
    double time = 0;
    std::uint32_t frame = 0;
};

/// One effect at one level, to be tried on pictures.
class Method {
public:
    virtual ~Method() = default;
    /// The effect with its values; they may be changed for a metric's own input by drawing another entry.
    virtual const ChainEntry& entry() const = 0;
    /// What comes out, 3 channels, scene-linear, working in rgba32f. Throws Error.
    virtual Image64 draw(const ChainEntry& entry, const MethodInput& input) const = 0;
};

/// The method's entry with other values. Throws Error for an unknown parameter.
ChainEntry entry_with(const Method& method, const std::map<std::string, double>& values);

struct RegisteredMetric {
    std::string effect; ///< id
    std::string name;   ///< "edge_position": lower is better, 0 is perfect
    std::string unit;   ///< "px", "" for a share
    std::string help;   ///< what it is, in one line
    /// Where a truth only has statistics: this is the error, as a share of the picture's root mean square like that of
    /// other effects.
    bool stands_for_error;
    double (*measure)(const Method& method);
};

/// All of them, in no order.
std::vector<RegisteredMetric>& registered_metrics();

/// `static const RegisterMetric registered("effect", "name", "unit", "help", measure);` at the end of the metric's file.
struct RegisterMetric {
    RegisterMetric(std::string effect, std::string name, std::string unit, std::string help,
                   double (*measure)(const Method&), bool stands_for_error = false) {
        registered_metrics().push_back({std::move(effect), std::move(name), std::move(unit), std::move(help),
                                        stands_for_error, measure});
    }
};

} // namespace postfx::host
