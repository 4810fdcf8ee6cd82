// The program from outside: statuses, messages, and the JSON that scripts rely on. Commands that draw have
// their own.
#include "program.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>

namespace fs = std::filesystem;
using namespace postfx::testing;
using Json = nlohmann::ordered_json;

namespace {

/// Names of the commands, from the program's own help.
std::vector<std::string> commands() {
    std::istringstream help(run_program({"--help"}).out);
    std::vector<std::string> names;
    std::string line;
    while (std::getline(help, line) && line != "Subcommands:") {
    }
    while (std::getline(help, line) && line.starts_with("  "))
        names.push_back(line.substr(2, line.find(' ', 2) - 2));
    return names;
}

Json json_of(const Outcome& outcome) {
    INFO(outcome.err);
    REQUIRE(outcome.status == 0);
    return Json::parse(outcome.out);
}

std::set<std::string> keys_of(const Json& object) {
    std::set<std::string> keys;
    for (const auto& [key, value] : object.items())
        keys.insert(key);
    return keys;
}

std::vector<std::string> effect_ids() {
    std::vector<std::string> ids;
    for (const Json& effect : json_of(run_program({"list", "effects", "--json"})))
        ids.push_back(effect["id"]);
    return ids;
}

} // namespace

TEST_CASE("every command answers --help and refuses an unknown option") {
    const std::vector<std::string> names = commands();
    REQUIRE(names.size() >= 6);
    for (const std::string& name : names) {
        INFO(name);
        const Outcome help = run_program({name, "--help"});
        CHECK(help.status == 0);
        CHECK(help.err.empty());
        CHECK_THAT(help.out, Catch::Contains("Usage: postfx " + name));
        check_refused(run_program({name, "--no-such-option"}), "");
    }
    check_refused(run_program({"schema", "--no-such-option"}), "--no-such-option");
}

TEST_CASE("a wrong command is refused with the nearest one") {
    check_refused(run_program({"descrbe"}), "did you mean \"describe\"?");
    check_refused(run_program({}), "--help");
    CHECK(run_program({"--version"}).status == 0);
}

TEST_CASE("list effects tells every folder of plugins/") {
    std::vector<std::string> folders;
    for (const fs::directory_entry& entry : fs::directory_iterator(POSTFX_SOURCE_DIRECTORY "/plugins")) {
        const std::string name = entry.path().filename().string();
        if (fs::exists(entry.path() / (name + ".cpp"))) folders.push_back(name);
    }
    std::sort(folders.begin(), folders.end());
    CHECK(effect_ids() == folders);

    const Json effect = json_of(run_program({"list", "effects", "--json"})).at(0);
    CHECK(keys_of(effect) == std::set<std::string>{"id", "stage", "help", "version", "module"});
    const Outcome text = run_program({"list", "effects"});
    CHECK_THAT(text.out, Catch::Contains(effect["help"].get<std::string>()));
    CHECK_THAT(run_program({"list", "effects", "-v"}).out,
               Catch::Contains(effect["module"].get<std::string>()));
}

TEST_CASE("list chains and scenes tell the files of configs/") {
    const std::string kind = GENERATE("chains", "scenes");
    const Json items = json_of(run_program({"list", kind, "--json"}));
    REQUIRE_FALSE(items.empty());
    for (const Json& item : items) {
        CHECK(keys_of(item) == std::set<std::string>{"id", "help", "path"});
        CHECK(fs::is_regular_file(item["path"].get<std::string>()));
    }
    CHECK_THAT(run_program({"list", kind}).out, Catch::StartsWith(items[0]["id"].get<std::string>()));
    check_refused(run_program({"list", "pictures"}), "pictures");
}

TEST_CASE("describe tells every effect's declaration") {
    for (const std::string& id : effect_ids()) {
        INFO(id);
        const Json effect = json_of(run_program({"describe", id, "--json"}));
        CHECK(keys_of(effect)
              == std::set<std::string>{"id", "version", "help", "stage", "parameters", "reads", "levels",
                                       "default_level", "module"});
        CHECK(effect["id"] == id);
        const std::string text = run_program({"describe", id}).out;
        for (const Json& parameter : effect["parameters"]) {
            INFO(parameter.dump());
            CHECK(keys_of(parameter)
                  == std::set<std::string>{"id", "type", "default", "min", "max", "step", "unit", "identity",
                                           "help", "choices", "constant"});
            if (parameter["type"] == "float" || parameter["type"] == "int") {
                CHECK(parameter["min"].get<double>() <= parameter["default"].get<double>());
                CHECK(parameter["max"].get<double>() >= parameter["default"].get<double>());
            } else if (parameter["type"] == "choice") {
                const Json& choices = parameter["choices"];
                CHECK(std::find(choices.begin(), choices.end(), parameter["default"]) != choices.end());
            }
            CHECK_THAT(text, Catch::Contains(parameter["id"].get<std::string>()));
        }
    }
    const std::string first = effect_ids().at(0);
    check_refused(run_program({"describe", first + "x"}), "did you mean " + Json(first).dump());
}

TEST_CASE("plugins that are no plugins are told, and the others still work") {
    const TemporaryDirectory scratch;
    std::ofstream(scratch.path() / "postfx_broken.so") << "no ELF";
    const Outcome outcome = run_program({"list", "effects", "--plugin-dir", scratch.path()});
    CHECK(outcome.status == 0);
    CHECK_FALSE(outcome.out.empty());
    CHECK_THAT(outcome.err, Catch::Contains("postfx_broken.so"));
    check_refused(run_program({"list", "effects", "--plugin-dir", (scratch / "missing").string()}),
                  "missing");
}

TEST_CASE("schema is printed or written") {
    const TemporaryDirectory scratch;
    const Outcome printed = run_program({"schema"});
    const Json schema = json_of(printed);
    CHECK_THAT(schema["$schema"].get<std::string>(), Catch::Contains("json-schema.org"));
    for (const std::string& id : effect_ids())
        CHECK_THAT(printed.out, Catch::Contains(Json(id).dump()));

    const std::string file = (scratch / "chain.schema.json").string();
    const Outcome written = run_program({"schema", "-o", file});
    CHECK(written.status == 0);
    CHECK((file_bytes(file) == printed.out));
    check_refused(run_program({"schema", "-o", (scratch / "missing/schema.json").string()}),
                  "missing/schema.json");
}
