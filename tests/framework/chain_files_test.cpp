// Chain files: includes, overrides, and files that mean harm or are broken.
#include <catch2/catch.hpp>

#include "chain_fixture.hpp"

#include <temporary_directory.hpp>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <thread>

#include <sys/stat.h>

namespace fs = std::filesystem;
using namespace chain_fixture;

namespace {

/// A folder of chain files that goes away with the test.
class ChainFolder {
public:
    fs::path write(const std::string& name, const std::string& text) const {
        fs::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return folder_ / name;
    }
    Chain read(const std::string& name) const { return postfx::read_chain(folder_ / name, catalog()); }
    /// The message with this folder's own path taken out.
    std::string error(const std::string& name) const {
        std::string message = error_of([&] { read(name); });
        const std::string prefix = folder_.path().string() + "/";
        for (std::size_t at = message.find(prefix); at != std::string::npos; at = message.find(prefix)) {
            message.erase(at, prefix.size());
        }
        return message;
    }
    const fs::path& path() const { return folder_.path(); }

private:
    postfx::testing::TemporaryDirectory folder_;
};

} // namespace

TEST_CASE("an include that is not beside the file is looked for in the include directories") {
    const ChainFolder folder;
    folder.write("shipped/base.yaml", "effects: [shade]");
    folder.write("shipped/other.yaml", "effects: [shade]");
    folder.write("mine/other.yaml", "effects: [blur]");
    folder.write("mine/a.yaml", "include: base.yaml");
    folder.write("mine/b.yaml", "include: other.yaml");
    const std::vector<fs::path> directories = {folder.path() / "shipped"};
    CHECK(names(postfx::read_chain(folder.path() / "mine/a.yaml", catalog(), directories)) == Names{"shade"});
    CHECK(names(postfx::read_chain(folder.path() / "mine/b.yaml", catalog(), directories)) == Names{"blur"});
    CHECK(folder.error("mine/a.yaml").find("can't include \"base.yaml\"") != std::string::npos);
}

TEST_CASE("an included chain's budget and pins hold until they are replaced") {
    using postfx::Budget;
    const ChainFolder folder;
    folder.write("base.yaml", "budget: {ms: 6}\neffects: [blur: {pin: low}]");
    folder.write("same.yaml", "include: base.yaml");
    folder.write("other.yaml", "include: base.yaml\nbudget: {error: 0.1}\noverrides: {blur: {quality: low}}");
    folder.write("pinned.yaml", "include: other.yaml\noverrides: {blur: {pin: high}}");
    CHECK(folder.read("same.yaml").budget == Budget{Budget::Of::ms, 6});
    CHECK(folder.read("same.yaml").entries[0].pinned);
    CHECK(folder.read("other.yaml").budget == Budget{Budget::Of::error, 0.1});
    CHECK_FALSE(folder.read("other.yaml").entries[0].pinned);
    CHECK(folder.read("pinned.yaml").entries[0].pinned);
    CHECK(folder.read("pinned.yaml").entries[0].level == 1);
    folder.write("both.yaml", "include: base.yaml\noverrides: {blur: {quality: low, pin: low}}");
    CHECK(
        folder.error("both.yaml")
        == "both.yaml:2:34: blur has quality and pin; give quality, or pin to keep the level under a budget");
}

TEST_CASE("an included chain comes first, changed by overrides") {
    const ChainFolder folder;
    folder.write("base/default.yaml", "effects: [shade, blur: {taps: 3}]");
    folder.write("base/night.yaml",
                 "include: default.yaml\noverrides: {shade: {radius: 0.5}}\neffects: [shade]");
    folder.write("top.yaml", "effects: [blur]\n" // the order of the keys does not matter
                             "overrides:\n"
                             "  shade: {enabled: false}\n"
                             "  blur: {quality: low, intensity: 1}\n"
                             "  shade_2:\n"
                             "include: base/night.yaml\n");
    const Chain chain = folder.read("top.yaml");
    REQUIRE(names(chain) == Names{"shade", "blur", "shade_2", "blur_2"});
    CHECK_FALSE(chain.entries[0].enabled);
    CHECK(chain.entries[0].values[0][0] == 0.5);
    CHECK(chain.entries[1].level == 0);
    CHECK(chain.entries[1].values[0][0] == 1);
    CHECK(chain.entries[1].values[1][0] == 3);
    CHECK(chain.entries[2].values[0][0] == 0.75);
    CHECK(chain.entries[3].level == 1);

    const fs::path absolute = folder.path() / "base" / "default.yaml";
    CHECK(names(parse("include: " + absolute.string())) == Names{"shade", "blur"});
    CHECK(names(postfx::parse_chain("include: default.yaml", folder.path() / "base" / "text", catalog()))
          == Names{"shade", "blur"});
}

TEST_CASE("mistakes in includes and overrides") {
    const ChainFolder folder;
    folder.write("default.yaml", "effects: [shade]");
    folder.write("none.yaml", "effects: []");
    folder.write("wrong.yaml", "effects:\n- shade: {radius: 2}\n");
    folder.write("big.yaml", std::string(2 * 1024 * 1024, '#'));
    fs::create_directory(folder.path() / "folder");
    const auto [yaml, expected] = GENERATE(table<std::string, std::string>({
        {"include: defualt.yaml",
         R"(t.yaml:1:10: can't include "defualt.yaml": no such file; did you mean "default.yaml"?)"},
        {"include: ../../nowhere/x.yaml",
         R"(t.yaml:1:10: can't include "../../nowhere/x.yaml": no such file)"},
        {"include: folder", R"(t.yaml:1:10: can't include "folder": is a directory, expected a chain)"},
        {"include: default.yaml/x", R"(t.yaml:1:10: can't include "default.yaml/x": no such file)"},
        {"include: big.yaml",
         R"(t.yaml:1:10: can't include "big.yaml": is larger than 1024 KiB, expected a chain)"},
        {"include: wrong.yaml", "wrong.yaml:2:19: shade.radius = 2 is outside 0..1 (height)"},
        {"include: ./t.yaml", "t.yaml:1:10: files include each other in a circle: t.yaml -> t.yaml"},
        {"include: default.yaml\noverrides: {shad: {radius: 0}}",
         R"(t.yaml:2:13: the included chain has no entry "shad"; did you mean "shade"?)"},
        {"include: none.yaml\noverrides: {shade: {radius: 0}}",
         R"(t.yaml:2:13: the included chain has no entry "shade"; it is empty)"},
        {"include: default.yaml\noverrides: {shade: {radius: 2}}",
         "t.yaml:2:29: shade.radius = 2 is outside 0..1 (height)"},
        {"include: default.yaml\noverrides: {shade: {name: x}}",
         "t.yaml:2:21: an override can't change the name of an included effect"},
        {"include: default.yaml\noverrides: {shade: 3}",
         R"(t.yaml:2:20: override of shade: expected a map {parameter: value}, found "3")"},
        {"include: default.yaml\noverrides: [shade]",
         R"(t.yaml:2:12: "overrides": expected a map {name: {parameter: value}}, found a list)"},
        {"include: default.yaml\neffects: [shade: {name: shade}]",
         R"(t.yaml:2:25: shade.name: another effect of this chain has the name "shade")"},
    }));
    INFO(yaml);
    folder.write("t.yaml", yaml);
    CHECK(folder.error("t.yaml") == expected);
}

TEST_CASE("a chain comes through a pipe, and its includes from the pipe's folder") {
    const ChainFolder folder;
    folder.write("base.yaml", "effects: [shade]");
    const fs::path pipe = folder.path() / "pipe";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    std::thread writer([&] { std::ofstream(pipe) << "include: base.yaml\neffects: [blur]"; });
    const Chain chain = folder.read("pipe");
    writer.join();
    CHECK(names(chain) == Names{"shade", "blur"});
}

TEST_CASE("a chain in a pipe without a folder includes from the current one") {
    const ChainFolder folder;
    folder.write("base.yaml", "effects: [shade]");
    const fs::path before = fs::current_path();
    fs::current_path(folder.path());
    for (const char* origin : {"standard input", "/dev/stdin", "/dev/fd/63"}) {
        INFO(origin);
        CHECK(names(postfx::parse_chain("include: base.yaml", origin, catalog())) == Names{"shade"});
    }
    fs::current_path(before);
}

TEST_CASE("files that are none") {
    const ChainFolder folder;
    folder.write("default.yaml", "effects: []");
    CHECK(folder.error("defalt.yaml") == R"(defalt.yaml: no such file; did you mean "default.yaml"?)");
    CHECK(error_of([&] { postfx::read_chain(folder.path(), catalog()); })
          == folder.path().string() + ": is a directory, expected a chain");
    CHECK(error_of([&] { postfx::read_chain("/dev/zero", catalog()); })
          == "/dev/zero: is larger than 1024 KiB, expected a chain");
    CHECK(error_of([&] { postfx::read_chain("", catalog()); }).find("no such file") != std::string::npos);
}

TEST_CASE("includes in a circle are named, however the path is written") {
    const ChainFolder folder;
    folder.write("a.yaml", "include: sub/b.yaml");
    folder.write("sub/b.yaml", "effects: []\ninclude: ../sub/c.yaml");
    folder.write("sub/c.yaml", "include: link.yaml");
    fs::create_symlink("b.yaml", folder.path() / "sub" / "link.yaml");
    CHECK(folder.error("a.yaml")
          == "sub/c.yaml:1:10: files include each other in a circle: sub/b.yaml -> sub/c.yaml -> "
             "sub/link.yaml");
}

TEST_CASE("a long row of includes is refused, a short one is not") {
    const ChainFolder folder;
    for (int i = 0; i < 17; ++i) {
        folder.write(std::to_string(i) + ".yaml", "include: " + std::to_string(i + 1) + ".yaml");
    }
    folder.write("17.yaml", "effects: [shade]");
    CHECK(names(folder.read("2.yaml")) == Names{"shade"}); // 16 files
    CHECK(folder.error("1.yaml") == "16.yaml:1:10: more than 16 files include each other");
}

TEST_CASE("hostile text is refused") {
    const std::string laughs =
        "a: &a [x, x, x, x, x, x, x, x, x]\nb: &b [*a, *a, *a, *a, *a, *a, *a, *a, *a]\n"
        "c: &c [*b, *b, *b, *b, *b, *b, *b, *b, *b]\neffects: [*c, *c, *c, *c, *c]\n";
    CHECK(parse_error(laughs)
          == R"(c.yaml:1:4: anchors (&a) are not supported; share values with "include")");

    CHECK(parse_error(repeat("[", 16) + repeat("]", 16)).find("nested") == std::string::npos);
    CHECK(parse_error(repeat("[", 17) + repeat("]", 17)) == "c.yaml:1:17: nested more than 16 deep");
    for (const char* opening : {"[", "{a: ", "- ", "? ", "[{"}) {
        CHECK_THAT(parse_error(repeat(opening, 100000)), Catch::EndsWith(": nested more than 16 deep"));
    }
    CHECK(parse_error(repeat("]", 100000))
          == "c.yaml:1:1: this is not YAML: \"]\" closes nothing that was opened");

    CHECK(parse_error(repeat("1,", 100000).insert(0, 1, '['))
          == "c.yaml:1:39998: more than 20000 values, expected a chain");

    const std::string filler(2 * 1024 * 1024, ' ');
    CHECK(parse_error("effects: []" + filler) == "c.yaml: is larger than 1024 KiB, expected a chain");
    CHECK(names(parse("effects: [shade]" + std::string(1024 * 1024 - 16, '\n'))) == Names{"shade"});

    CHECK(parse_error("effects: [" + repeat("shade, ", 256) + "]") == "no error");
    CHECK(parse_error("effects: [" + repeat("shade, ", 257) + "]")
          == "c.yaml:1:1803: more than 256 effects in one chain");
}

TEST_CASE("text that is no text is refused") {
    using namespace std::string_literals;
    const auto [yaml, expected] = GENERATE(table<std::string, std::string>({
        {"effects: []\n\0"s, "c.yaml:2:1: expected plain text in UTF-8, found the byte 0x00"},
        {"effects: [\x04]"s, "c.yaml:1:11: expected plain text in UTF-8, found the byte 0x04"},
        {"effects: [\x7F]"s, "c.yaml:1:11: expected plain text in UTF-8, found the byte 0x7F"},
        {"\xFF\xFE"
         "e\0f\0"s,
         "c.yaml:1:1: expected text in UTF-8, found the byte 0xFF out of place"},                  // UTF-16
        {"# \xE4\n"s, "c.yaml:1:3: expected text in UTF-8, found the byte 0xE4 out of place"},     // Latin-1
        {"# \xC0\xAF\n"s, "c.yaml:1:3: expected text in UTF-8, found the byte 0xC0 out of place"}, // overlong
        {"# \xE0\x80\xAF\n"s, "c.yaml:1:3: expected text in UTF-8, found the byte 0xE0 out of place"},
        {"# \xED\xA0\x80\n"s,
         "c.yaml:1:3: expected text in UTF-8, found the byte 0xED out of place"}, // surrogate
        {"# \xF4\x90\x80\x80\n"s, "c.yaml:1:3: expected text in UTF-8, found the byte 0xF4 out of place"},
        {"# \xE2\x82"s, "c.yaml:1:3: expected text in UTF-8, found the byte 0xE2 out of place"}, // cut short
    }));
    CHECK(parse_error(yaml) == expected);
    CHECK(parse_error("# \xF0\x9F\x8C\x83 \xE2\x82\xAC \xC3\xA4\neffects: []") == "no error");
}

TEST_CASE("damaged chains are read or refused, and nothing else happens") {
    const std::vector<std::string> seeds = {
        "effects:\n  - shade\n  - blur: {intensity: 1.5, taps: 3, wrap: true, shape: round}\n",
        "effects:\n  - blur:\n      tint: [1, 0.5, 0]\n      quality: low\n      name: haze\n  - blur: "
        "{enabled: false}\n",
        "# a comment\n---\n{\"effects\": [\"shade\", {\"blur\": {\"taps\": 4}}]}\n...\n",
        "effects:\n  - shade: {radius: !!float 1e-1, name: &x \"a\\u00e4\"}\n  - ? blur\n    : |\n      "
        "text\n  - *x\n",
    };
    const std::string telling = "[]{}:,-?&*!|>'\"%@`#~ \n\t\r\\<.0e\x04\xC3\xFF";
    std::mt19937 random(20240607); // fixed: the same 20,000 texts everywhere
    const auto below = [&](std::size_t n) { return random() % n; };

    int read = 0, refused = 0;
    for (int round = 0; round < 20000; ++round) {
        std::string yaml = seeds[below(seeds.size())];
        for (std::size_t changes = 1 + below(3); changes > 0 && !yaml.empty(); --changes) {
            const std::size_t at = below(yaml.size());
            switch (below(5)) {
            case 0:
                yaml[at] = telling[below(telling.size())];
                break;
            case 1:
                yaml[at] = static_cast<char>(below(256));
                break;
            case 2:
                yaml.insert(at, 1, telling[below(telling.size())]);
                break;
            case 3:
                yaml.erase(at, 1 + below(8));
                break;
            case 4:
                yaml += yaml.substr(at, 20);
                break;
            }
        }
        CAPTURE(round, yaml);
        try {
            parse(yaml);
            ++read;
        } catch (const postfx::Error& error) {
            ++refused;
            const std::string message = error.what();
            REQUIRE(message.starts_with("c.yaml:"));
            REQUIRE(message.find('\n') == std::string::npos);
        }
    }
    // Both ways out were taken, else the texts were no test.
    CHECK(read > 100);
    CHECK(refused > 100);
}
