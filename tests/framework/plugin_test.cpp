// Finding, opening and checking plugins; no OpenGL.
#include <catch2/catch.hpp>

#include "fixtures.hpp"

#include <temporary_directory.hpp>

#include <postfx/catalog.hpp>
#include <postfx/chain.hpp>
#include <postfx/error.hpp>
#include <postfx/plugin.hpp>

#include <sys/stat.h>

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

namespace fs = std::filesystem;
using postfx::Catalog;
using postfx::testing::fixture;
using postfx::testing::TemporaryDirectory;

namespace {

/// Plugins are looked for in `path` and nowhere else.
class Environment {
public:
    explicit Environment(const std::string& path) {
        ::setenv("POSTFX_PLUGIN_PATH", path.c_str(), 1);
        ::setenv("XDG_DATA_HOME", "/nonexistent", 1);
    }
    ~Environment() {
        ::unsetenv("POSTFX_PLUGIN_PATH");
        ::unsetenv("XDG_DATA_HOME");
    }
};

fs::path directory_with(const TemporaryDirectory& scratch, const std::string& name,
                        const std::vector<std::string>& fixtures) {
    fs::create_directory(scratch / name);
    for (const std::string& f : fixtures)
        fs::copy_file(fixture(f), scratch / name / ("postfx_" + f + ".so"));
    return scratch / name;
}

std::string load_error(const fs::path& module) {
    Catalog catalog;
    try {
        catalog.load(module);
    } catch (const postfx::Error& error) {
        return error.what();
    }
    return "";
}

void plan_nothing(const postfx::Request&, postfx::Builder& out) {
    out.lacks("this is a test");
}

postfx::Effect sample(const char* id = "sample") {
    return postfx::effect<plan_nothing>(id);
}

/// What the catalog says to one effect; "" when it takes it.
std::string add_error(const postfx_effect& effect) {
    const postfx_effect* const effects[] = {&effect};
    postfx_module module{};
    module.struct_size = sizeof(module);
    module.abi_major = POSTFX_ABI_MAJOR;
    module.effect_count = 1;
    module.effects = effects;
    Catalog catalog;
    try {
        catalog.add(module, "m.so");
    } catch (const postfx::Error& error) {
        return error.what();
    }
    return "";
}

std::string parameter_error(const postfx_parameter& parameter) {
    postfx_effect effect = sample();
    effect.parameters = &parameter;
    effect.parameter_count = 1;
    effect.parameter_stride = sizeof(parameter);
    return add_error(effect);
}

} // namespace

// ---- discovery

TEST_CASE("the plugin path is searched in order, and a found effect shadows later ones") {
    const TemporaryDirectory scratch;
    const fs::path a = directory_with(scratch, "a", {"tint", "blur"});
    const fs::path b = directory_with(scratch, "b", {"tint", "shift"});
    const Environment environment(a.string() + ":" + b.string());

    const Catalog found = Catalog::discover();
    CHECK(found.ids() == std::vector<std::string>{"blur", "shift", "tint"});
    CHECK(found.find("tint")->module_path == a / "postfx_tint.so");
    CHECK(found.find("none") == nullptr);
    CHECK(found.notes()
          == std::vector<std::string>{(b / "postfx_tint.so").string() + ": tint is shadowed by "
                                      + (a / "postfx_tint.so").string()});

    const Catalog first = Catalog::discover({b});
    CHECK(first.find("tint")->module_path == b / "postfx_tint.so");

    const Catalog twice = Catalog::discover({a, a / "."}); // a shadows b's as before, but not itself
    CHECK(twice.notes() == found.notes());
}

TEST_CASE("unsafe entries of the plugin path are refused with a note") {
    const TemporaryDirectory scratch;
    const fs::path good = directory_with(scratch, "good", {"tint"});
    const fs::path open = directory_with(scratch, "open", {"blur"});
    REQUIRE(::chmod(open.c_str(), 0777) == 0);
    const Environment environment(":relative/plugins:" + open.string()
                                  + ":/nonexistent/plugins:" + good.string());
    const Catalog found = Catalog::discover();
    CHECK(found.ids() == std::vector<std::string>{"tint"});
    CHECK(found.notes()
          == std::vector<std::string>{
              "POSTFX_PLUGIN_PATH: \"\" is refused, not an absolute path",
              "POSTFX_PLUGIN_PATH: \"relative/plugins\" is refused, not an absolute path",
              open.string() + ": refused, the directory is writable by everybody",
          });
}

TEST_CASE("where it looked is told, and noted when nothing was found") {
    const TemporaryDirectory scratch;
    const fs::path empty = directory_with(scratch, "empty", {});
    const Environment environment(empty.string());
    const Catalog found = Catalog::discover();
    REQUIRE_FALSE(found.searched().empty());
    CHECK(found.searched().front() == empty);
    if (found.effects().empty()) { // an installation on this machine may have some
        CHECK(found.notes().size() == found.searched().size());
        CHECK(found.notes().front() == "no effect was found in " + empty.string());
    }
}

TEST_CASE("the current directory is never searched") {
    const TemporaryDirectory scratch;
    const fs::path here = directory_with(scratch, "here", {"tint"});
    const Environment environment("");
    const fs::path before = fs::current_path();
    fs::current_path(here);
    const Catalog found = Catalog::discover();
    fs::current_path(before);
    CHECK(found.ids().empty());
}

TEST_CASE("a directory that the user names may be relative but must exist") {
    const TemporaryDirectory scratch;
    const fs::path here = directory_with(scratch, "here", {"tint"});
    const Environment environment("");
    const fs::path before = fs::current_path();
    fs::current_path(scratch.path());
    const Catalog found = Catalog::discover({"here"});
    fs::current_path(before);
    CHECK(found.ids() == std::vector<std::string>{"tint"});
    CHECK_THROWS_WITH(Catalog::discover({scratch / "absent"}),
                      (scratch / "absent").string() + ": no such plugin directory");
}

TEST_CASE("only postfx_*.so files are opened, and one bad module does not hide the others") {
    const TemporaryDirectory scratch;
    const fs::path mixed = directory_with(scratch, "mixed", {"tint", "wrong_major", "unknown_words"});
    fs::copy_file(fixture("blur"), mixed / "blur.so");
    fs::copy_file(fixture("blur"), mixed / "postfx_blur.so.bak");
    postfx::testing::put_bytes(mixed / "postfx_text.so", std::string(200, 'x'));
    fs::create_directory(mixed / "postfx_folder.so");
    fs::create_symlink("postfx_circle.so", mixed / "postfx_circle.so");
    fs::copy_file(fixture("shift"), mixed / "postfx_open.so");
    REQUIRE(::chmod((mixed / "postfx_open.so").c_str(), 0666) == 0);
    const Environment environment(mixed.string());
    const Catalog found = Catalog::discover();
    CHECK(found.ids() == std::vector<std::string>{"after", "before", "tint"});
    const std::string at = mixed.string() + "/postfx_";
    CHECK(found.notes()
          == std::vector<std::string>{
              at + "circle.so: no such plugin file",
              at + "folder.so: no such plugin file",
              at + "open.so: refused, the file is writable by everybody",
              at + "text.so: not a loadable plugin: " + at + "text.so: invalid ELF header",
              at + "unknown_words.so: later: parameter shape has the unknown kind \"spline\"",
              at + "wrong_major.so: has ABI major version 2, this host speaks 1",
          });
}

// ---- opening

TEST_CASE("a file that is no plugin of this version is refused in one line") {
    const TemporaryDirectory scratch;
    CHECK(load_error(scratch / "absent.so") == (scratch / "absent.so").string() + ": no such plugin file");
    CHECK(load_error(fixture("wrong_major"))
          == fixture("wrong_major").string() + ": has ABI major version 2, this host speaks 1");
    CHECK(load_error(fixture("no_symbol"))
          == fixture("no_symbol").string()
                 + ": not a postfx plugin of major version 1: it does not export postfx_module_v1");
    CHECK(load_error(fixture("unknown_words"))
          == fixture("unknown_words").string() + ": later: parameter shape has the unknown kind \"spline\"");
}

TEST_CASE("a plugin that was copied half is refused, wherever it was cut") {
    const TemporaryDirectory scratch;
    const std::string whole = postfx::testing::file_bytes(fixture("tint"));
    REQUIRE(whole.size() > 1000);
    for (std::size_t part = 0; part < 20; ++part) {
        const fs::path cut = scratch / ("cut_" + std::to_string(part) + ".so");
        postfx::testing::put_bytes(cut, whole.substr(0, whole.size() * part / 20));
        INFO(cut);
        CHECK(load_error(cut).starts_with(cut.string() + ": not a loadable plugin: "));
    }
}

TEST_CASE("a bad effect is refused, its module's good ones are not") {
    Catalog catalog;
    CHECK_THROWS_AS(catalog.load(fixture("unknown_words")), postfx::Error);
    CHECK(catalog.ids() == std::vector<std::string>{"after", "before"});
}

TEST_CASE("structs of a later minor version are read as far as they are known") {
    Catalog catalog;
    catalog.load(fixture("grown"));
    const postfx::EffectPtr grown = catalog.find("grown");
    REQUIRE(grown);
    REQUIRE(grown->parameters.size() == 3);
    CHECK(grown->parameters[1].id == "second");
    CHECK(grown->parameters[2].default_value[0] == 0.75);
    CHECK(grown->parameters[2].help == "Blue");
}

TEST_CASE("a C plugin is as good as a C++ one") {
    Catalog catalog;
    catalog.load(fixture("plain_c"));
    const postfx::EffectPtr effect = catalog.find("plain_c");
    REQUIRE(effect);
    CHECK(effect->version == "1.0.0");
    CHECK(effect->stage == postfx::EffectStage::scene);
    CHECK(effect->parameters.at(0).identity == 1.0);
    CHECK(effect->sources.at(0).not_pointwise == "");
}

// ---- declarations

TEST_CASE("declarations arrive as they were made") {
    const postfx::EffectPtr tint = postfx::testing::fixtures().find("tint");
    REQUIRE(tint->parameters.size() == 3);
    CHECK(tint->help == "Colours the picture");
    const postfx::ParameterInfo& tone = tint->parameters[1];
    CHECK(tone.kind == postfx::ParameterKind::color);
    CHECK(tone.kind_name() == "color");
    CHECK(tone.components() == 3);
    CHECK(tone.maximum == 4);
    CHECK_FALSE(tone.identity);
    const postfx::ParameterInfo& mode = tint->parameters[2];
    CHECK(mode.kind_name() == "choice");
    CHECK(mode.choices == std::vector<std::string>{"multiply", "add"});
    CHECK(mode.constant);
    CHECK(tint->find_parameter("tone") == 1u);
    CHECK_FALSE(tint->find_parameter("tones"));
    CHECK(tint->default_values()
          == std::vector<postfx::Value>{{0.5, 0, 0, 0}, {1, 0.5, 0.25, 0}, {0, 0, 0, 0}});

    const postfx::EffectPtr blur = postfx::testing::fixtures().find("blur");
    CHECK(blur->levels.at(1).id == "high");
    CHECK(blur->default_level == 1);
    CHECK(blur->find_source("blur_line.glsl") != nullptr);
    CHECK(fs::path(blur->find_source("blur.glsl")->path).filename() == "blur.glsl");

    postfx::Chain chain;
    const postfx::ChainEntry& entry = chain.add(postfx::testing::fixtures(), "blur");
    CHECK(entry.values == blur->default_values());
    CHECK(entry.level == 1);
}

TEST_CASE("a wrong parameter is refused with effect and field") {
    using postfx::Parameter;
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    static constexpr const char* words[] = {"one", "two"};
    static constexpr const char* holes[] = {"one", nullptr};
    struct Case {
        Parameter parameter;
        std::string why;
    };
    const auto changed = [](Parameter parameter, auto change) {
        change(parameter);
        return parameter;
    };
    const std::vector<Case> cases = {
        {postfx::number("Strength", 0), "parameter id \"Strength\" is not [a-z][a-z0-9_]*"},
        {postfx::number("", 0), "parameter id \"\" is not [a-z][a-z0-9_]*"},
        {postfx::number("a__b", 0), "parameter id \"a__b\" is not [a-z][a-z0-9_]*"},
        {postfx::number("gl_x", 0), "parameter id \"gl_x\" is not [a-z][a-z0-9_]*"},
        {postfx::number(nullptr, 0), "parameter id \"\" is not [a-z][a-z0-9_]*"},
        {postfx::number("quality", 0), "parameter id \"quality\" is reserved"},
        {Parameter("x", "double"), "parameter x has the unknown kind \"double\""},
        {Parameter("x", nullptr), "parameter x has the unknown kind \"\""},
        {postfx::number("x", 1).range(1, 1), "parameter x has the range 1..1"},
        {postfx::number("x", 1).range(2, 1), "parameter x has the range 2..1"},
        {postfx::number("x", 1).range(0, infinity), "parameter x has the range 0..inf"},
        {postfx::number("x", 1).range(nan, 1), "parameter x has the range nan..1"},
        {postfx::number("x", 2), "parameter x has the default 2 outside its range 0..1"},
        {postfx::number("x", nan), "parameter x has the default nan outside its range 0..1"},
        {postfx::color("x", 0, 0, 2), "parameter x has the default 2 outside its range 0..1"},
        {postfx::number("x", 0).identity_at(-1), "parameter x has its identity -1 outside its range"},
        {postfx::number("x", 0).logarithmic(), "parameter x is logarithmic but may be 0 or less"},
        {postfx::color("x", 0, 0, 0).constant(), "color x can't be a constant"},
        {Parameter("x", "choice"), "parameter x of kind choice has 0 choices"},
        {changed(postfx::choice("x", words), [](Parameter& p) { p.kind = "float"; }),
         "parameter x of kind float has 2 choices"},
        {postfx::choice("x", holes), "parameter x has a choice without a name"},
        {postfx::choice("x", words).range(0, 5), "parameter x of kind choice has the range 0..5, not 0..1"},
        {postfx::toggle("x", false).range(0, 2), "parameter x of kind bool has the range 0..2, not 0..1"},
        {postfx::integer("x", 0).range(0, 1e10),
         "parameter x of kind int has the range 0..10000000000, more than 32 bits"},
        {changed(postfx::integer("x", 0), [](Parameter& p) { p.default_value[0] = 0.5; }),
         "parameter x of kind int has the default 0.5"},
    };
    for (const Case& c : cases)
        CHECK(parameter_error(c.parameter) == "m.so: sample: " + c.why);
}

TEST_CASE("a wrong effect is refused with its name and field") {
    struct Case {
        std::string why;
        void (*change)(postfx_effect&);
    };
    static constexpr const char* reads_color[] = {"color"};
    static constexpr postfx::Parameter twice[] = {postfx::number("x", 0), postfx::number("x", 0)};
    static constexpr postfx_level levels[] = {postfx::level("low", "")};
    const std::vector<Case> cases = {
        {"m.so: Sample: effect id \"Sample\" is not [a-z][a-z0-9_]*",
         [](postfx_effect& e) { e.id = "Sample"; }},
        {"m.so: effect id \"\" is not [a-z][a-z0-9_]*", [](postfx_effect& e) { e.id = nullptr; }},
        {"m.so: sample: has the unknown stage \"print\"", [](postfx_effect& e) { e.stage = "print"; }},
        {"m.so: sample: has the unknown stage \"\"", [](postfx_effect& e) { e.stage = nullptr; }},
        {"m.so: sample: has no plan function", [](postfx_effect& e) { e.plan = nullptr; }},
        {"m.so: sample: needs ABI 1.7, this is 1.0", [](postfx_effect& e) { e.min_host_minor = 7; }},
        {"m.so: sample: reads the unknown attachment \"color\"",
         [](postfx_effect& e) {
             e.reads = reads_color;
             e.read_count = 1;
         }},
        {"m.so: sample: declares the parameter x twice",
         [](postfx_effect& e) {
             e.parameters = twice;
             e.parameter_count = 2;
             e.parameter_stride = sizeof(twice[0]);
         }},
        {"m.so: sample: parameters have a stride of " + std::to_string(sizeof(postfx_parameter) - 8)
             + " bytes, at least " + std::to_string(sizeof(postfx_parameter)) + " expected",
         [](postfx_effect& e) {
             e.parameters = twice;
             e.parameter_count = 2;
             e.parameter_stride = sizeof(twice[0]) - 8;
         }},
        {"m.so: sample: has the default level 3 of 1",
         [](postfx_effect& e) {
             e.levels = levels;
             e.level_count = 1;
             e.level_stride = sizeof(levels[0]);
             e.default_level = 3;
         }},
        {"m.so: sample: its description has " + std::to_string(offsetof(postfx_effect, plan))
             + " bytes; this is older than ABI 1.0",
         [](postfx_effect& e) { e.struct_size = offsetof(postfx_effect, plan); }},
    };
    for (const Case& c : cases) {
        postfx_effect effect = sample();
        c.change(effect);
        CHECK(add_error(effect) == c.why);
    }
    CHECK(add_error(sample()) == "");
}

TEST_CASE("what a struct of an earlier writer does not have reads as zero") {
    static constexpr const char* words[] = {"one", "two"};
    postfx_parameter shrunk = postfx::choice("x", words);
    shrunk.struct_size = offsetof(postfx_parameter, choices);
    CHECK(parameter_error(shrunk) == "m.so: sample: parameter x of kind choice has 0 choices");
    shrunk.struct_size = 0;
    CHECK(parameter_error(shrunk) == "m.so: sample: parameter id \"\" is not [a-z][a-z0-9_]*");
}

TEST_CASE("a module with a hole in its list of effects is refused") {
    const postfx::Effect good = sample();
    const postfx_effect* const effects[] = {nullptr, &good};
    postfx_module module{};
    module.struct_size = sizeof(module);
    module.abi_major = POSTFX_ABI_MAJOR;
    module.effect_count = 2;
    module.effects = effects;
    Catalog catalog;
    CHECK_THROWS_WITH(catalog.add(module, "m.so"), "m.so: effect 0 of its list is missing");
    CHECK(catalog.ids() == std::vector<std::string>{"sample"});
}
