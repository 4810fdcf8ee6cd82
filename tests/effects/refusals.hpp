// What effects may refuse, as they declare it beside themselves. A suite that tries many values counts such a refusal
// as one; every other error is a mistake.
#pragma once

#include <testing.hpp>

#include <fnmatch.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <vector>

namespace postfx::testing {

/// The file `refusals.txt` beside an effect's GLSL has a line for each message that the effect refuses values with, as
/// errors have it: "letterbox: top and bottom leave nothing*". A * stands for any text, such as numbers; empty lines
/// and those that start with # say nothing. An effect without the file refuses nothing.
class PinnedRefusals {
public:
    explicit PinnedRefusals(const Catalog& effects) {
        for (const EffectPtr& effect : effects.effects())
            read(*effect);
    }

    /// Is this refusal one of those that were declared?
    bool expects(const Refusal& refusal) {
        for (const std::string& pattern : patterns_) {
            if (::fnmatch(pattern.c_str(), refusal.what(), 0) != 0) continue;
            seen_.insert(pattern);
            return true;
        }
        return false;
    }

    /// Declared, and never asked for with expects().
    std::vector<std::string> unseen() const {
        std::vector<std::string> left;
        for (const std::string& pattern : patterns_) {
            if (!seen_.contains(pattern)) left.push_back(pattern);
        }
        return left;
    }

private:
    void read(const EffectInfo& effect) {
        for (const SourceInfo& source : effect.sources) {
            std::ifstream file(std::filesystem::path(source.path).parent_path() / "refusals.txt");
            for (std::string line; std::getline(file, line);) {
                if (!line.empty() && line[0] != '#') patterns_.insert(line);
            }
        }
    }

    std::set<std::string> patterns_, seen_;
};

} // namespace postfx::testing
