// Chain text: what is read, and for every mistake the one message that a user gets.
#include <catch2/catch.hpp>

#include "chain_fixture.hpp"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

using namespace chain_fixture;

TEST_CASE("an effect alone has its defaults") {
    const Chain chain = parse("effects:\n  - blur\n  - shade:\n");
    REQUIRE(names(chain) == Names{"blur", "shade"});
    const ChainEntry& entry = chain.entries[0];
    CHECK(entry.effect == catalog().find("blur"));
    CHECK(entry.enabled);
    CHECK(entry.level == 1);
    CHECK(entry.values == std::vector<postfx::Value>{{0.25}, {8}, {0}, {1}, {1, 0.5, 0}});
}

TEST_CASE("values of every kind are read") {
    const Chain chain = parse("effects:\n"
                              "  - blur: {intensity: 1.5e0, taps: 3, wrap: true, shape: hexagon,\n"
                              "           tint: [2, +.5, 0.], quality: low, enabled: false, name: haze}\n");
    REQUIRE(names(chain) == Names{"haze"});
    const ChainEntry& entry = chain.entries[0];
    CHECK_FALSE(entry.enabled);
    CHECK(entry.level == 0);
    CHECK(entry.values == std::vector<postfx::Value>{{1.5}, {3}, {1}, {2}, {2, 0.5, 0}});
}

TEST_CASE("what may look odd is legal") {
    const auto [yaml, expected] = GENERATE(table<std::string, Names>({
        {"effects: []", {}},
        {"effects:\n  # - blur\n", {}}, // everything commented out
        {"effects: [blur, shade]", {"blur", "shade"}},
        {"{\"effects\": [\"blur\", {\"shade\": {\"radius\": 0.5}}]}", {"blur", "shade"}}, // JSON is YAML
        {"---\neffects: [blur]\n...\n", {"blur"}},
        {"%YAML 1.2\n---\neffects: [blur]\n", {"blur"}},
        {"\xEF\xBB\xBF"
         "effects: [blur]\n",
         {"blur"}}, // byte order mark
        {"effects:\r\n- blur\r\n- shade: {radius: 1}\r\n", {"blur", "shade"}},
        {"effects: [blur, blur, blur]", {"blur", "blur_2", "blur_3"}},
        {"effects: [blur: {name: haze}, blur]", {"haze", "blur"}},
        {"effects: [shade: {name: blur}, blur]", {"blur", "blur_2"}},
        {"effects: [shade: {name: blur_2}, blur, blur]", {"blur_2", "blur", "blur_3"}},
        {"effects: [blur, blur: {name: blur_2}]", {"blur", "blur_2"}},
        {"effects: [blur: {name: \"haze\"}]", {"haze"}},
        {"# Straße\neffects: [blur]", {"blur"}},
    }));
    INFO(yaml);
    CHECK(names(parse(yaml)) == expected);
}

TEST_CASE("numbers") {
    const auto [text, expected] = GENERATE(table<std::string, double>({
        {"0", 0},
        {"4", 4},
        {"4.0", 4},
        {"+1", 1},
        {"1e-3", 0.001},
        {"1E0", 1},
        {".5", 0.5},
        {"-0.0", 0},
        {"0x1", 1},
        {"0o1", 1},
        {"01", 1}, // not octal: that was YAML 1.1
        {"1e-999", 0},
    }));
    INFO(text);
    const Chain chain = parse("effects: [blur: {intensity: " + text + "}]");
    CHECK(chain.entries[0].values[0][0] == expected);
    CHECK_FALSE(std::signbit(chain.entries[0].values[0][0]));
}

TEST_CASE("true and false in YAML's three spellings") {
    const auto [text, expected] = GENERATE(table<std::string, bool>({{"true", true},
                                                                     {"True", true},
                                                                     {"TRUE", true},
                                                                     {"false", false},
                                                                     {"False", false},
                                                                     {"FALSE", false}}));
    INFO(text);
    CHECK(parse("effects: [blur: {enabled: " + text + "}]").entries[0].enabled == expected);
    CHECK(parse("effects: [blur: {wrap: " + text + "}]").entries[0].values[2][0] == (expected ? 1 : 0));
}

TEST_CASE("text that only looks like a mistake is legal") {
    const auto yaml = GENERATE(as<std::string>(), "# it's {commented [out\neffects: [blur]",
                               "effects:\n- \"blur\":\n    shape: 'round'\n",
                               "effects:\n- blur: {\n    taps: 3, # a [ here\n    shape: \"round\"\n  }\n",
                               "effects: [blur: {tint: [1,1,1]}]", "effects:\t[blur]\n");
    INFO(yaml);
    CHECK(names(parse(yaml)) == Names{"blur"});
}

TEST_CASE("one number is a grey color, a whole float is an int") {
    const Chain chain = parse("effects: [blur: {tint: 0.5, taps: 3.0}]");
    CHECK(chain.entries[0].values[4] == postfx::Value{0.5, 0.5, 0.5, 0});
    CHECK(chain.entries[0].values[1] == postfx::Value{3});
}

TEST_CASE("every mistake has its message") {
    const auto [yaml, expected] = GENERATE(table<std::string, std::string>({
        // the file as a whole
        {"", R"(c.yaml:1:1: the chain is empty; expected "effects" or "include")"},
        {"# nothing but this\n", R"(c.yaml:1:1: the chain is empty; expected "effects" or "include")"},
        {"{}", R"(c.yaml:1:1: expected "effects" or "include", found neither)"},
        {"- blur\n",
         R"(c.yaml:1:1: a chain: expected "effects:" and a list, or "include:" and a file, found a list)"},
        {"blur",
         R"(c.yaml:1:1: a chain: expected "effects:" and a list, or "include:" and a file, found "blur")"},
        {"efects: []", R"(c.yaml:1:1: a chain has no key "efects"; did you mean "effects"?)"},
        {"effects: []\nplugins: []",
         R"(c.yaml:2:1: a chain has no key "plugins"; expected one of budget, effects, include, overrides, skip)"},
        {"effects: blur", R"(c.yaml:1:10: "effects": expected a list of effects, found "blur")"},
        {"effects:\n  blur:\n", R"(c.yaml:2:3: "effects": expected a list of effects, found a map)"},
        {"effects: []\neffects: []", R"(c.yaml:2:1: "effects" is given twice)"},
        {"effects: []\n---\neffects: []",
         R"(c.yaml:2:1: a second document starts here; expected one document)"},
        {"overrides: {}\neffects: []",
         R"(c.yaml:1:1: "overrides" needs "include": it changes included effects)"},
        {"include: [a.yaml]", R"(c.yaml:1:10: "include": expected the name of a chain file, found a list)"},
        {"include:", R"(c.yaml:1:1: "include": expected the name of a chain file, found nothing)"},
        // items
        {"effects:\n  - blurr\n", R"(c.yaml:2:5: no effect "blurr"; did you mean "blur"?)"},
        {"effects:\n  - sparkle\n", R"(c.yaml:2:5: no effect "sparkle"; expected one of blur, shade)"},
        {"effects:\n  - Shade: {radius: 0.5}\n", R"(c.yaml:2:5: no effect "Shade"; did you mean "shade"?)"},
        {"effects: [[blur]]",
         R"(c.yaml:1:11: an item of "effects": expected an effect, or "effect: {parameter: value}", found a list)"},
        {"effects: [{}]", R"(c.yaml:1:11: expected an effect, found an empty map)"},
        {"effects: [~]",
         R"(c.yaml:1:11: an item of "effects": expected an effect, or "effect: {parameter: value}", found nothing)"},
        {"effects:\n  - blur:\n    taps: 3\n",
         R"(c.yaml:3:5: "taps" stands beside "blur"; indent it further if it belongs to "blur", or begin a new item with "- ")"},
        {"effects:\n  - blur: 0.5\n", R"(c.yaml:2:11: blur: expected a map {parameter: value}, found "0.5")"},
        {"effects:\n  - blur: [0.5]\n",
         R"(c.yaml:2:11: blur: expected a map {parameter: value}, found a list)"},
        {"effects: [blur, blur: {name: blur}]",
         R"(c.yaml:1:30: blur.name: another effect of this chain has the name "blur")"},
        {"effects: [shade: {name: My Shade}]",
         R"(c.yaml:1:25: shade.name: expected lower-case letters, digits and _, a letter first, found "My Shade")"},
        {"effects: [shade: {name: [a]}]",
         R"(c.yaml:1:25: shade.name: expected lower-case letters, digits and _, a letter first, found a list)"},
        // settings
        {"effects:\n  - blur:\n      intensty: 1\n",
         R"(c.yaml:3:7: blur has no parameter "intensty"; did you mean "intensity"?)"},
        {"effects: [shade: {enable: true}]",
         R"(c.yaml:1:19: shade has no parameter "enable"; did you mean "enabled"?)"},
        {"effects: [shade: {zzzzzzzz: 1}]",
         R"(c.yaml:1:19: shade has no parameter "zzzzzzzz"; expected one of radius, enabled, quality, pin, name)"},
        {"effects: [blur: {taps: 3, taps: 4}]", R"(c.yaml:1:27: "taps" is given twice)"},
        {"effects: [shade: {[radius]: 1}]", R"(c.yaml:1:19: expected a word as key, found a list)"},
        {"effects: [shade: {~: 1}]", R"(c.yaml:1:19: expected a word as key, found nothing)"},
        {"effects: [shade: {enabled: yes}]",
         R"(c.yaml:1:28: shade.enabled: expected true or false, found "yes"; write true)"},
        {"effects: [shade: {enabled: Off}]",
         R"(c.yaml:1:28: shade.enabled: expected true or false, found "Off"; write false)"},
        {"effects: [shade: {enabled: n}]",
         R"(c.yaml:1:28: shade.enabled: expected true or false, found "n"; write false)"},
        {"effects: [shade: {enabled: tRUE}]",
         R"(c.yaml:1:28: shade.enabled: expected true or false, found "tRUE"; write true)"},
        {"effects: [shade: {enabled: \"true\"}]",
         R"(c.yaml:1:28: shade.enabled: expected true or false, found the text "true")"},
        {"effects: [shade: {quality: low}]", R"(c.yaml:1:28: shade has no quality levels)"},
        {"effects: [blur: {quality: hihg}]",
         R"(c.yaml:1:27: blur.quality: expected one of low, high, found "hihg"; did you mean "high"?)"},
        {"effects: [blur: {quality: 1}]",
         R"(c.yaml:1:27: blur.quality: expected one of low, high, found "1")"},
        {"effects: [blur: {quality: }]",
         R"(c.yaml:1:18: blur.quality: expected one of low, high, found nothing)"},
        // numbers
        {"effects: [shade: {radius: 2.4}]", R"(c.yaml:1:27: shade.radius = 2.4 is outside 0..1 (height))"},
        {"effects: [shade: {radius: -1e-9}]",
         R"(c.yaml:1:27: shade.radius = -1e-09 is outside 0..1 (height))"},
        {"effects: [shade: {radius: wide}]",
         R"(c.yaml:1:27: shade.radius: expected a number in 0..1 (height), found "wide")"},
        {"effects: [shade: {radius: \"0.5\"}]",
         R"(c.yaml:1:27: shade.radius: expected a number in 0..1 (height), found the text "0.5")"},
        {"effects: [shade: {radius: 0.5m}]",
         R"(c.yaml:1:27: shade.radius: expected a number in 0..1 (height), found "0.5m")"},
        {"effects: [shade: {radius: 0x10}]", R"(c.yaml:1:27: shade.radius = 16 is outside 0..1 (height))"},
        {"effects: [shade: {radius: 0x}]",
         R"(c.yaml:1:27: shade.radius: expected a number in 0..1 (height), found "0x")"},
        {"effects: [shade: {radius: .inf}]", R"(c.yaml:1:27: shade.radius = inf is outside 0..1 (height))"},
        {"effects: [shade: {radius: 1_0}]",
         R"(c.yaml:1:27: shade.radius: expected a number in 0..1 (height), found "1_0")"},
        // a decimal comma, in blocks, in maps and in lists
        {"effects:\n- shade:\n    radius: 0,5",
         R"(c.yaml:3:13: shade.radius: expected a number in 0..1 (height), found "0,5"; decimals are written with a point: 0.5)"},
        {"effects: [shade: {radius: 0,5}]",
         R"(c.yaml:1:27: radius: expected a number, found "0,5"; decimals are written with a point: 0.5)"},
        {"effects: [shade: {radius: -0,25, enabled: true}]",
         R"(c.yaml:1:27: radius: expected a number, found "-0,25"; decimals are written with a point: -0.25)"},
        {"effects: [blur: {tint: [0,5, 0,2, 1]}]",
         R"(c.yaml:1:24: blur.tint: expected [red, green, blue] or one number, each in 0..2, found 5 of them; decimals are written with a point: 0.5)"},
        // a missing colon, blank or comma
        {"effects:\n- shade {radius: 1}",
         R"(c.yaml:2:3: no effect "shade {radius"; a colon is missing behind "shade")"},
        {"effects:\n- blur {taps: 3, intensity: 1}",
         R"(c.yaml:2:3: this is not YAML: a colon is missing behind "blur")"},
        {"effects:\n- shade\n    radius: 1",
         R"(c.yaml:2:3: this is not YAML: a colon is missing behind "shade")"},
        {"effects\n- shade: {radius: 1}",
         R"(c.yaml:1:1: this is not YAML: a colon is missing behind "effects")"},
        {"effects\n  - shade: {radius: 1}",
         R"(c.yaml:1:1: this is not YAML: a colon is missing behind "effects")"},
        {"effects [shade]",
         R"(c.yaml:1:1: a chain: expected "effects:" and a list, or "include:" and a file, found "effects [shade]"; a colon is missing behind "effects")"},
        {"effects: [shade: {radius 1}]",
         R"(c.yaml:1:19: shade has no parameter "radius 1"; a colon is missing behind "radius")"},
        {"effects: [shade: {radius:1}]",
         R"(c.yaml:1:19: shade has no parameter "radius:1"; a blank is missing behind "radius:")"},
        {"effects: [shade: {radius = 1}]",
         R"(c.yaml:1:19: shade has no parameter "radius = 1"; write "radius: ...", with a colon)"},
        {"effects:\n- shade:\n    radius 1",
         R"(c.yaml:3:5: shade: expected a map {parameter: value}, found "radius 1"; a colon is missing behind "radius")"},
        {"effects:\n- shade:{radius: 1}",
         R"(c.yaml:2:3: no effect "shade:{radius"; a blank is missing behind "shade:")"},
        {"effects:\n-shade", R"(c.yaml:2:1: a chain has no key "-shade"; a blank is missing behind "-")"},
        {"effects: [shade]\nbudget: {ms 3}",
         R"(c.yaml:2:10: "budget" has no key "ms 3"; a colon is missing behind "ms")"},
        {"effects: [blur: {taps: 3 intensity: 1}]",
         R"(c.yaml:1:26: this is not YAML: a comma is missing before "intensity")"},
        {"effects:\n- shade: radius: 1",
         R"(c.yaml:2:16: this is not YAML: a second key stands on this line; give it a line of its own, indented further, or write {key: value})"},
        // quotes and brackets that are not closed
        {"effects:\n- blur: {shape: \"round}\n- shade",
         R"(c.yaml:2:17: this is not YAML: the quote that opens here is not closed on its line)"},
        {"effects:\n- blur: {shape: \"round}\n- blur: {shape: \"round\"}",
         R"(c.yaml:2:17: this is not YAML: the quote that opens here is not closed on its line)"},
        {"effects:\n- 'shade\n",
         R"(c.yaml:2:3: this is not YAML: the quote that opens here is never closed)"},
        {"effects:\n- shade: {radius: 1\n- blur: {taps: 3}\n",
         R"(c.yaml:2:10: this is not YAML: the "{" that opens here is never closed)"},
        {"effects: [shade: {radius: 1]",
         R"(c.yaml:1:18: this is not YAML: the "{" that opens here is not closed before "]")"},
        {"effects:\n- shade: {radius: 1}}",
         R"(c.yaml:2:21: this is not YAML: "}" closes nothing that was opened)"},
        {"effects: [shade: {radius: +-1}]",
         R"(c.yaml:1:27: shade.radius: expected a number in 0..1 (height), found "+-1")"},
        {"effects: [shade: {radius: ++1}]",
         R"(c.yaml:1:27: shade.radius: expected a number in 0..1 (height), found "++1")"},
        {"effects: [shade: {radius: .nan}]",
         R"(c.yaml:1:27: shade.radius: expected a number in 0..1 (height), found ".nan")"},
        {"effects: [shade: {radius: inf}]",
         R"(c.yaml:1:27: shade.radius: expected a number in 0..1 (height), found "inf")"},
        {"effects: [shade: {radius: 1e999}]",
         R"(c.yaml:1:27: shade.radius: "1e999" does not fit a 64-bit float; expected a number in 0..1 (height))"},
        {"effects: [shade: {radius: [0.5]}]",
         R"(c.yaml:1:27: shade.radius: expected a number in 0..1 (height), found a list)"},
        {"effects:\n  - shade:\n      radius:\n",
         R"(c.yaml:3:7: shade.radius: expected a number in 0..1 (height), found nothing)"},
        {"effects: [blur: {taps: 3.5}]",
         R"(c.yaml:1:24: blur.taps = 3.5 is not whole; expected a whole number in 1..64)"},
        {"effects: [blur: {taps: 65}]", R"(c.yaml:1:24: blur.taps = 65 is outside 1..64)"},
        {"effects: [blur: {taps: many}]",
         R"(c.yaml:1:24: blur.taps: expected a whole number in 1..64, found "many")"},
        // toggles, choices, colors
        {"effects: [blur: {wrap: 1}]", R"(c.yaml:1:24: blur.wrap: expected true or false, found "1")"},
        {"effects: [blur: {shape: sqare}]",
         R"(c.yaml:1:25: blur.shape: expected one of round, square, hexagon, found "sqare"; did you mean "square"?)"},
        {"effects: [blur: {shape: [round]}]",
         R"(c.yaml:1:25: blur.shape: expected one of round, square, hexagon, found a list)"},
        {"effects: [blur: {tint: [1, 1]}]",
         R"(c.yaml:1:24: blur.tint: expected [red, green, blue] or one number, each in 0..2, found 2 of them)"},
        {"effects: [blur: {tint: [1, 1, 3]}]", R"(c.yaml:1:31: blur.tint blue = 3 is outside 0..2)"},
        {"effects: [blur: {tint: '#ff0000'}]",
         R"(c.yaml:1:24: blur.tint: expected [red, green, blue] or one number, each in 0..2, found the text "#ff0000")"},
        {"effects: [blur: {tint: {r: 1}}]",
         R"(c.yaml:1:24: blur.tint: expected [red, green, blue] or one number, each in 0..2, found a map)"},
        // YAML itself
        {"effects: [blur\n", R"(c.yaml:1:10: this is not YAML: the "[" that opens here is never closed)"},
        {"effects:\n\t- blur\n",
         R"(c.yaml:2:1: this is not YAML: a tab indents this line; YAML wants spaces)"},
        {"effects:\n- shade:\n\t  radius: 1\n",
         R"(c.yaml:3:1: this is not YAML: a tab indents this line; YAML wants spaces)"},
        {"effects: [&b blur, *b]",
         R"(c.yaml:1:11: anchors (&b) are not supported; share values with "include")"},
        {"effects: [*b]", R"(c.yaml:1:11: this is not YAML: the referenced anchor is not defined)"},
        {"effects: [blur: {<<: {taps: 3}}]",
         R"(c.yaml:1:18: merge keys (<<) are not supported; share values with "include")"},
        {"effects: [!!str blur]", R"(c.yaml:1:11: tags ("tag:yaml.org,2002:str") are not supported)"},
        {"effects: !mine [blur]", R"(c.yaml:1:10: tags ("!mine") are not supported)"},
        {"effects:\r\n- shade:\r\n    radius: 2\r\n",
         R"(c.yaml:3:13: shade.radius = 2 is outside 0..1 (height))"},
        {"\xEF\xBB\xBF"
         "effets: []",
         R"(c.yaml:1:1: a chain has no key "effets"; did you mean "effects"?)"},
        // a column counts characters: two before the place are of two bytes
        {"effects: [blur: {\"\xC3\xA4\xC3\xB6\": 1, x: 1}]",
         "c.yaml:1:18: blur has no parameter \"\xC3\xA4\xC3\xB6\"; expected one of intensity, taps, wrap, "
         "shape, tint, enabled, quality, pin, name"},
        {"effects: [\"\xC3\xA4\xC3\xB6\": {}, {}]",
         "c.yaml:1:11: no effect \"\xC3\xA4\xC3\xB6\"; expected one of blur, shade"},
        {"# \xC3\xA4\xC3\xB6\n{\"\xC3\xA4\": 1, \"\xC3\xA4\": 2}",
         "c.yaml:2:10: \"\xC3\xA4\" is given twice"},
    }));
    INFO(yaml);
    CHECK(parse_error(yaml) == expected);
}

TEST_CASE("a chain says what may be skipped") {
    using postfx::Skip;
    CHECK(parse("effects: [blur]\n").skip == Skip::code);
    CHECK(parse("skip: nothing\neffects: [blur]\n").skip == Skip::nothing);
    CHECK(parse("skip: exact\neffects: [blur]\n").skip == Skip::exact);
    CHECK(parse("effects: [blur]\nskip: visible\n").skip == Skip::visible);
    CHECK(parse_error("skip: all\neffects: [blur]\n")
          == "c.yaml:1:7: \"skip\": expected nothing, exact, code or visible, found \"all\"");
    CHECK(parse_error("skip: [exact]\neffects: [blur]\n")
          == "c.yaml:1:7: \"skip\": expected nothing, exact, code or visible, found a list");
}

TEST_CASE("a chain asks for a budget") {
    using postfx::Budget;
    CHECK_FALSE(parse("effects: [blur]").budget);
    CHECK(parse("budget: {ms: 6}\neffects: [blur]").budget == Budget{Budget::Of::ms, 6});
    CHECK(parse("effects: [blur]\nbudget: {error: 1e-2}").budget == Budget{Budget::Of::error, 0.01});
    const auto [budget, expected] = GENERATE(table<std::string, std::string>({
        {"6", R"(c.yaml:1:9: "budget": expected {ms: MILLISECONDS} or {error: SHARE}, found "6")"},
        {"{}", R"(c.yaml:1:9: "budget": expected {ms: MILLISECONDS} or {error: SHARE}, found a map)"},
        {"", R"(c.yaml:1:1: "budget": expected {ms: MILLISECONDS} or {error: SHARE}, found nothing)"},
        {"{ms: 6, error: 1}",
         R"(c.yaml:1:17: "budget" has two keys; expected one of them: {ms: MILLISECONDS} or {error: SHARE})"},
        {"{eror: 1}", R"(c.yaml:1:10: "budget" has no key "eror"; did you mean "error"?)"},
        {"{seconds: 1}", R"(c.yaml:1:10: "budget" has no key "seconds"; expected one of ms, error)"},
        {"{ms: 0}", R"(c.yaml:1:14: budget.ms: expected a number above 0, found "0")"},
        {"{ms: -6}", R"(c.yaml:1:14: budget.ms: expected a number above 0, found "-6")"},
        {"{ms: .inf}", R"(c.yaml:1:14: budget.ms: expected a number above 0, found ".inf")"},
        {"{ms: 1e999}",
         R"(c.yaml:1:14: budget.ms: "1e999" does not fit a 64-bit float; expected a number above 0)"},
        {"{error: small}", R"(c.yaml:1:17: budget.error: expected a number above 0, found "small")"},
    }));
    CHECK(parse_error("budget: " + budget + "\neffects: [blur]") == expected);
}

TEST_CASE("a budget on the command line") {
    using postfx::Budget;
    CHECK(postfx::parse_budget("ms=6", "--budget") == Budget{Budget::Of::ms, 6});
    CHECK(postfx::parse_budget("error=0.01", "--budget") == Budget{Budget::Of::error, 0.01});
    const auto message = [](const std::string& text) {
        return error_of([&] { postfx::parse_budget(text, "--budget"); });
    };
    CHECK(message("6") == "--budget: expected ms=MILLISECONDS or error=SHARE, found \"6\"");
    CHECK(message("seconds=1")
          == "--budget:1:1: \"budget\" has no key \"seconds\"; expected one of ms, error");
    CHECK(message("ms=fast") == "--budget:1:5: budget.ms: expected a number above 0, found \"fast\"");
}

TEST_CASE("a level is pinned") {
    const ChainEntry entry = parse("effects: [blur: {pin: low}]").entries[0];
    CHECK(entry.level == 0);
    CHECK(entry.pinned);
    CHECK_FALSE(parse("effects: [blur: {quality: low}]").entries[0].pinned);
    CHECK(parse_error("effects: [blur: {pin: lwo}]")
          == R"(c.yaml:1:23: blur.pin: expected one of low, high, found "lwo"; did you mean "low"?)");
    CHECK(parse_error("effects: [shade: {pin: low}]") == "c.yaml:1:24: shade has no quality levels");
    CHECK(parse_error("effects: [blur: {pin: low, quality: high}]")
          == "c.yaml:1:28: blur has quality and pin; give quality, or pin to keep the level under a budget");
}

TEST_CASE("an error knows its place") {
    try {
        parse("effects:\n  - shade: {radius: 2}\n");
        FAIL("accepted");
    } catch (const postfx::Error& error) {
        CHECK(error.place().file == "c.yaml");
        CHECK(error.place().line == 2);
        CHECK(error.place().column == 21);
        CHECK(error.message() == "shade.radius = 2 is outside 0..1 (height)");
    }
}

TEST_CASE("a message stays on one line and short, whatever the file says") {
    const std::string long_word(5000, 'x');
    const std::string message = parse_error("effects: [\"a\\nb\\tc" + long_word + "\"]");
    CHECK(message
          == "c.yaml:1:11: no effect \"a b c" + long_word.substr(0, 55)
                 + "...\"; expected one of blur, shade");
    // A cut in the middle of a two-byte character goes before it.
    const std::string umlauts = parse_error("effects: [a" + repeat("\xC3\xA4", 100) + "]");
    CHECK(umlauts
          == "c.yaml:1:11: no effect \"a" + repeat("\xC3\xA4", 29) + "...\"; expected one of blur, shade");
}

TEST_CASE("one effect on the command line") {
    Chain chain;
    postfx::parse_chain_entry("shade", "--effect", catalog(), chain);
    postfx::parse_chain_entry("blur: {intensity: 0.5}", "--effect", catalog(), chain);
    postfx::parse_chain_entry("blur", "--effect", catalog(), chain);
    CHECK(names(chain) == Names{"shade", "blur", "blur_2"});
    CHECK(chain.entries[1].values[0][0] == 0.5);

    const auto message = [&](const std::string& yaml) {
        return error_of([&] { postfx::parse_chain_entry(yaml, "--effect", catalog(), chain); });
    };
    CHECK(message("") == "--effect:1:1: expected an effect, found nothing");
    CHECK(message("blurr") == R"(--effect:1:1: no effect "blurr"; did you mean "blur"?)");
    CHECK(message("blur: {tap: 1}") == R"(--effect:1:8: blur has no parameter "tap"; did you mean "taps"?)");
    CHECK(message("blur: {") == R"(--effect:1:7: this is not YAML: the "{" that opens here is never closed)");
    CHECK(
        message("[blur]")
        == R"(--effect:1:1: an item of "effects": expected an effect, or "effect: {parameter: value}", found a list)");
    CHECK(names(chain) == Names{"shade", "blur", "blur_2"}); // a mistake adds nothing
}

TEST_CASE("values set from code") {
    Chain chain;
    ChainEntry& entry = chain.add(catalog(), "blur");
    CHECK(entry.set("intensity", 2));
    CHECK(entry.values[0][0] == 2);
    CHECK_FALSE(entry.set("intensity", 9));
    CHECK(entry.values[0][0] == 4);
    CHECK_FALSE(entry.set("intensity", std::numeric_limits<double>::quiet_NaN()));
    CHECK(entry.values[0][0] == 4);
    CHECK_FALSE(entry.set("intensity", -std::numeric_limits<double>::infinity()));
    CHECK(entry.values[0][0] == 0);
    CHECK(entry.set("taps", 3.4));
    CHECK(entry.values[1][0] == 3);
    CHECK(entry.set("wrap", 1));
    CHECK(entry.values[2][0] == 1);
    CHECK_FALSE(entry.set("shape", 7));
    CHECK(entry.values[3][0] == 2);
    CHECK(entry.set("tint", 0.25));
    CHECK(entry.values[4] == postfx::Value{0.25, 0.25, 0.25, 0});
    CHECK(error_of([&] { entry.set("intensty", 1); })
          == R"(blur has no parameter "intensty"; did you mean "intensity"?)");

    chain.add(catalog(), "blur");
    REQUIRE(chain.find("blur_2") != nullptr);
    CHECK(chain.find("blur_2")->values[0][0] == 0.25);
    CHECK(chain.find("blur_3") == nullptr);
    CHECK(error_of([&] { chain.add(catalog(), "blr"); }) == R"(no effect "blr"; did you mean "blur"?)");
    CHECK(error_of([&] { chain.add(postfx::Catalog(), "blur"); })
          == R"(no effect "blur"; no plugins were found)");
}

TEST_CASE("the schema says what the reader accepts") {
    const auto schema = nlohmann::json::parse(postfx::chain_schema(catalog()));
    CHECK(schema["$schema"] == "https://json-schema.org/draft/2020-12/schema");
    CHECK(schema["additionalProperties"] == false);
    CHECK(schema["properties"].size() == 5);
    CHECK(schema["dependentRequired"]["overrides"] == nlohmann::json::array({"include"}));
    CHECK(schema["anyOf"][0]["required"] == nlohmann::json::array({"effects"}));
    CHECK(schema["anyOf"][1]["required"] == nlohmann::json::array({"include"}));

    const auto& item = schema["properties"]["effects"]["items"]["anyOf"];
    CHECK(item[0]["enum"] == nlohmann::json::array({"blur", "shade"}));
    CHECK(item[1]["properties"]["blur"]["$ref"] == "#/$defs/blur");
    CHECK(item[1]["additionalProperties"] == false);
    CHECK(item[1]["maxProperties"] == 1);
    CHECK(schema["properties"]["overrides"]["additionalProperties"]["anyOf"].size() == 2);

    const auto& effect = schema["$defs"]["blur"];
    CHECK(effect["description"] == "Spreads light");
    CHECK(effect["additionalProperties"] == false);
    const auto& settings = effect["properties"];
    CHECK(settings.size() == 9);
    const nlohmann::json intensity = {{"description", "How strong it is (stops)"},
                                      {"type", "number"},
                                      {"minimum", 0},
                                      {"maximum", 4},
                                      {"default", 0.25},
                                      {"x-unit", "stops"}};
    CHECK(settings["intensity"] == intensity);
    CHECK(settings["taps"]["type"] == "integer");
    CHECK(settings["taps"]["default"] == 8);
    CHECK(settings["wrap"]["type"] == "boolean");
    CHECK(settings["wrap"]["default"] == false);
    CHECK(settings["shape"]["enum"] == nlohmann::json::array({"round", "square", "hexagon"}));
    CHECK(settings["shape"]["default"] == "square");
    CHECK(settings["tint"]["anyOf"][0]["items"]["maximum"] == 2);
    CHECK(settings["tint"]["anyOf"][0]["maxItems"] == 3);
    CHECK(settings["tint"]["anyOf"][1]["type"] == "number");
    CHECK(settings["tint"]["default"] == nlohmann::json::array({1, 0.5, 0}));
    CHECK(settings["quality"]["enum"] == nlohmann::json::array({"low", "high"}));
    CHECK(settings["quality"]["default"] == "high");
    CHECK(settings["pin"]["enum"] == nlohmann::json::array({"low", "high"}));
    CHECK_FALSE(settings["pin"].contains("default"));
    CHECK(effect["not"]["required"] == nlohmann::json::array({"quality", "pin"}));
    CHECK(schema["properties"]["budget"]["maxProperties"] == 1);
    CHECK(schema["properties"]["budget"]["properties"]["ms"]["exclusiveMinimum"] == 0);
    CHECK_FALSE(schema["$defs"]["shade"]["properties"].contains("quality"));

    const auto without_plugins = nlohmann::json::parse(postfx::chain_schema(postfx::Catalog()));
    CHECK(without_plugins["properties"]["overrides"]["additionalProperties"] == false);
}

TEST_CASE("the schema is written the same way every time, in the order of the declaration") {
    const std::string text = postfx::chain_schema(catalog());
    CHECK(text == postfx::chain_schema(make_catalog()));
    CHECK(text.starts_with("{\n  \"$schema\""));
    CHECK(text.find("\"intensity\"") < text.find("\"taps\""));
    CHECK(text.find("\"taps\"") < text.find("\"enabled\""));
}
