#include <postfx/curves.hpp>

#include <postfx/error.hpp>

#include "base/read_file.hpp"
#include "chain/yaml_document.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace postfx {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t max_file_bytes = std::size_t{1024} * 1024;

/// Reads objects of a file strictly: every key is known and there, every value of its type.
class CurvesReader {
public:
    explicit CurvesReader(const std::string& origin) : place_{.file = origin} {}

    Curves read(const std::string& text) const {
        Json root;
        try {
            root = Json::parse(text);
        } catch (const Json::parse_error& error) {
            throw Error(place_, fmt::format("is not JSON: {}", error.what()));
        }
        expect_keys(root, "curves", {"device", "driver", "clock", "made_by", "base", "effects"});
        Curves curves;
        curves.device = word(root, "curves", "device");
        curves.driver = word(root, "curves", "driver");
        curves.clock = word(root, "curves", "clock");
        curves.made_by = word(root, "curves", "made_by");
        expect_keys(root["base"], "base", {"fixed_ms", "ms_per_megapixel", "exponent"});
        curves.base = time(root["base"], "base");
        if (!root["effects"].is_object()) refuse("effects", "an object {effect: [levels]}", root["effects"]);
        for (const auto& [effect, levels] : root["effects"].items())
            curves.effects[effect] = read_levels(levels, "effects." + effect);
        return curves;
    }

private:
    std::vector<LevelCurve> read_levels(const Json& json, const std::string& at) const {
        if (!json.is_array() || json.empty()) refuse(at, "a list of levels", json);
        std::vector<LevelCurve> levels;
        for (const Json& item : json) {
            const std::string here = fmt::format("{}[{}]", at, levels.size());
            expect_keys(item, here,
                        {"level", "fixed_ms", "ms_per_megapixel", "exponent", "error", "step_to_next"});
            LevelCurve level;
            level.level = word(item, here, "level");
            level.time = time(item, here);
            level.error = number(item, here, "error");
            level.step_to_next = number(item, here, "step_to_next");
            for (const LevelCurve& before : levels) {
                if (before.level == level.level)
                    throw Error(place_, fmt::format("{}.level: {} comes twice", here, quote(level.level)));
            }
            if (!levels.empty() && !(level.error < levels.back().error)) {
                throw Error(place_, fmt::format("{}.error: expected less than {}'s {}, found {}", here,
                                                levels.back().level, levels.back().error, level.error));
            }
            levels.push_back(std::move(level));
        }
        return levels;
    }

    TimeCurve time(const Json& object, const std::string& at) const {
        return {number(object, at, "fixed_ms"), number(object, at, "ms_per_megapixel"),
                object.contains("exponent") ? number(object, at, "exponent") : 1};
    }

    void expect_keys(const Json& object, const std::string& at, const std::vector<std::string>& keys) const {
        if (!object.is_object()) refuse(at, "an object", object);
        for (const auto& [key, value] : object.items()) {
            if (std::find(keys.begin(), keys.end(), key) == keys.end())
                throw Error(place_,
                            fmt::format("{} has no key {}{}", at, quote(key), did_you_mean(key, keys)));
        }
        for (const std::string& key : keys) {
            const bool optional = key == "exponent"; // written only where it is not 1
            if (!optional && !object.contains(key))
                throw Error(place_, fmt::format("{}: {} is missing", at, quote(key)));
        }
    }

    std::string word(const Json& object, const std::string& at, const std::string& key) const {
        const Json& value = object[key];
        if (!value.is_string()) refuse(at + "." + key, "text", value);
        return value.get<std::string>();
    }

    double number(const Json& object, const std::string& at, const std::string& key) const {
        const Json& value = object[key];
        const std::string expected = "a number that is not negative";
        if (!value.is_number()) refuse(at + "." + key, expected, value);
        const double found = value.get<double>();
        if (!std::isfinite(found) || found < 0) refuse(at + "." + key, expected, value);
        return found;
    }

    [[noreturn]] void refuse(const std::string& at, const std::string& expected, const Json& found) const {
        throw Error(place_, fmt::format("{}: expected {}, found {}", at, expected, shown(found)));
    }

    static std::string shown(const Json& value) {
        if (value.is_object()) return "an object";
        if (value.is_array()) return value.empty() ? "an empty list" : "a list";
        if (value.is_string()) return quote(value.get<std::string>());
        return value.dump();
    }

    Place place_;
};

} // namespace

const LevelCurve* Curves::find(const std::string& effect, const std::string& level) const {
    const auto levels = effects.find(effect);
    if (levels == effects.end()) return nullptr;
    const auto found = std::find_if(levels->second.begin(), levels->second.end(),
                                    [&](const LevelCurve& curve) { return curve.level == level; });
    return found == levels->second.end() ? nullptr : &*found;
}

Curves read_curves(const std::filesystem::path& file) {
    return CurvesReader(input_name(file)).read(read_file(file, max_file_bytes, "curves of what levels cost"));
}

std::string curves_json(const Curves& curves) {
    const auto with_time = [](Json object, const TimeCurve& time) {
        object["fixed_ms"] = time.fixed_ms;
        object["ms_per_megapixel"] = time.ms_per_megapixel;
        if (time.exponent != 1) object["exponent"] = time.exponent;
        return object;
    };
    Json effects = Json::object();
    for (const auto& [effect, levels] : curves.effects) {
        Json list = Json::array();
        for (const LevelCurve& level : levels) {
            Json item = with_time({{"level", level.level}}, level.time);
            item["error"] = level.error;
            item["step_to_next"] = level.step_to_next;
            list.push_back(std::move(item));
        }
        effects[effect] = std::move(list);
    }
    const Json json = {{"device", curves.device},
                       {"driver", curves.driver},
                       {"clock", curves.clock},
                       {"made_by", curves.made_by},
                       {"base", with_time(Json::object(), curves.base)},
                       {"effects", std::move(effects)}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace postfx
