// What accuracy costs: of each effect's levels the time and the error, as measured on one device.
#pragma once

#include <postfx/chain.hpp>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace postfx {

/// Time as a function of the picture's size.
struct TimeCurve {
    double fixed_ms = 0;
    double ms_per_megapixel = 0;
    double exponent = 1; ///< of the megapixels: above 1 where samples per pixel grow with the picture
    double at(double megapixels) const {
        return fixed_ms + ms_per_megapixel * std::pow(megapixels, exponent);
    }
};

/// One level of an effect.
struct LevelCurve {
    std::string level; ///< id; "" of an effect that has no levels
    TimeCurve time;    ///< that the effect adds to a chain
    /// Root mean square of the difference from the effect's truth, as a share of the truth's own root mean square; mean
    /// over scenes. Errors of several effects are taken to be independent: their squares add.
    double error = 0;
    /// LDR-FLIP, mean over pixels and scenes, between this level's picture and the next one's; 0 for the last.
    double step_to_next = 0;
};

struct Curves {
    std::string device, driver; ///< as OpenGL names them: renderer, version
    std::string clock;          ///< what the times are of
    std::string made_by;        ///< the command, and of which version
    TimeCurve base;             ///< of a chain without effects: encoding the picture
    /// By effect id; levels in order of decreasing error, and of increasing time where they were chosen: there none
    /// dominates another one. On another device one may; it is never chosen then.
    std::map<std::string, std::vector<LevelCurve>> effects;

    /// Null when the effect has no such level on its curve.
    const LevelCurve* find(const std::string& effect, const std::string& level) const;
};

/// Throws Error with the file and what was expected.
Curves read_curves(const std::filesystem::path& file);
/// As read_curves() reads it: JSON with 2-space indent.
std::string curves_json(const Curves& curves);

} // namespace postfx
