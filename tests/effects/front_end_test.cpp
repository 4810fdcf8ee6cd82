// Every shader that is assembled for an effect, at every level, in every form, is GLSL for a second front end too:
// glslangValidator, which is stricter than Mesa's. No OpenGL is needed.
#include "hard_inputs.hpp"

#include <temporary_directory.hpp>

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <fstream>
#include <map>
#include <sstream>
#include <utility>

#include <sys/wait.h>

using namespace postfx;
using namespace postfx::testing;

namespace {

/// Everything that decides which text is assembled: values in uniforms or compiled in, reads counted, stages fused
/// with the output.
std::vector<Named<PlanOptions>> forms() {
    std::vector<Named<PlanOptions>> forms(4, {"live", linear_output()});
    forms[1].name = "folded";
    forms[1].thing.fold = true;
    forms[2].name = "counting reads";
    forms[2].thing.count_taps = true;
    forms[3].name = "for the display";
    forms[3].thing.output = Output::display;
    return forms;
}

/// The defaults, then each other word of each choice and each toggle the other way.
std::vector<ChainEntry> variants(const ChainEntry& entry) {
    std::vector<ChainEntry> found{entry};
    for (const ParameterInfo& parameter : entry.effect->parameters) {
        if (parameter.kind != ParameterKind::toggle && parameter.kind != ParameterKind::choice) continue;
        for (int word = 0; word <= static_cast<int>(parameter.maximum); ++word) {
            found.push_back(entry);
            found.back().set(parameter.id, word);
        }
    }
    return found;
}

/// Shaders, each once, under the first name that it had.
class Shaders {
public:
    void add(const std::string& name, const Plan& plan) {
        for (const Pass& pass : plan.passes)
            texts_.try_emplace(pass.program->text, Shader{name + ", " + pass.name, pass.program->kind});
    }

    std::size_t count() const { return texts_.size(); }

    /// What glslangValidator says of those that it refuses; empty when it takes all.
    std::string complaints() const {
        const TemporaryDirectory scratch;
        std::string command = "cd " + scratch.path().string() + " && glslangValidator";
        std::map<std::string, std::string> names; // by file
        for (const auto& [text, shader] : texts_) {
            const char* stage = shader.kind == ProgramKind::compute ? "comp" : "frag";
            const std::string file = fmt::format("{}.{}", names.size(), stage);
            std::ofstream(scratch / file) << text;
            names[file] = shader.name;
            command += " " + file;
        }
        const auto [status, output] = output_of(command + " 2>&1");
        if (status == 0) return "";
        std::string found = fmt::format("status {}\n", status), name;
        std::istringstream lines(output);
        for (std::string line; std::getline(lines, line);) {
            if (names.contains(line)) { // each file is named before anything is said of it
                name = names.at(line) + ":\n";
            } else if (!line.empty()) {
                found += std::exchange(name, "") + "    " + line + "\n";
            }
        }
        return found;
    }

private:
    struct Shader {
        std::string name;
        ProgramKind kind;
    };

    static std::pair<int, std::string> output_of(const std::string& command) {
        std::FILE* pipe = ::popen(command.c_str(), "r");
        REQUIRE(pipe);
        std::string output;
        char part[4096];
        for (std::size_t size; (size = std::fread(part, 1, sizeof(part), pipe)) > 0;)
            output.append(part, size);
        const int status = ::pclose(pipe);
        return {WIFEXITED(status) ? WEXITSTATUS(status) : 128, output};
    }

    std::map<std::string, Shader> texts_;
};

} // namespace

TEST_CASE("a second front end takes every assembled shader of every effect and level") {
    REQUIRE(!catalog().effects().empty());
    Shaders shaders;
    Planner planner;
    for (const EffectPtr& effect : catalog().effects()) {
        const SceneFacts facts = facts_of(ordinary_input(effect->reads));
        for (const auto& [form, options] : forms()) {
            Chain chain;
            ChainEntry entry = chain.add(catalog(), effect->id);
            for (const std::string& level : names_of_levels(*effect)) {
                set_level(entry, level);
                for (const ChainEntry& variant : variants(entry))
                    shaders.add(fmt::format("{} {}, {}", effect->id, level, form),
                                planner.plan(Chain{{variant}}, facts, options));
            }
        }
    }
    fmt::print("{} shaders\n", shaders.count());
    const std::string complaints = shaders.complaints();
    INFO(complaints);
    CHECK(complaints.empty());
}

TEST_CASE("a shader that is no GLSL is found") {
    Plan plan;
    plan.passes.resize(1);
    plan.passes[0].name = "broken";
    ProgramSource source;
    source.text = "#version 450 core\nvoid main() { absent(); }\n";
    plan.passes[0].program = std::make_shared<const ProgramSource>(source);
    Shaders shaders;
    shaders.add("made up", plan);
    CHECK_THAT(shaders.complaints(), Catch::Contains("made up, broken") && Catch::Contains("absent"));
}
