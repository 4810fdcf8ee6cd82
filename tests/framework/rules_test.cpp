// Rules of the tree itself: what plugins export, that framework and host name no effect, and that truths share nothing with
// theirs.
#include <catch2/catch.hpp>

#include "fixtures.hpp"

#include <temporary_directory.hpp>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace fs = std::filesystem;
using postfx::testing::fixture;

namespace {

std::string output_of(const std::string& command) {
    FILE* pipe = ::popen(command.c_str(), "r");
    REQUIRE(pipe);
    std::string text;
    char part[4096];
    for (std::size_t n = 0; (n = std::fread(part, 1, sizeof(part), pipe)) > 0;)
        text.append(part, n);
    REQUIRE(::pclose(pipe) == 0);
    return text;
}

struct Symbol {
    char type = 0; ///< as nm prints it; 'u' is STB_GNU_UNIQUE
    std::string name;
};

std::vector<Symbol> exported(const fs::path& module) {
    std::istringstream lines(output_of("nm -D --defined-only '" + module.string() + "'"));
    std::vector<Symbol> symbols;
    std::string address, type, name;
    while (lines >> address >> type >> name)
        symbols.push_back({type.front(), name});
    return symbols;
}

std::vector<fs::path> built_plugins() {
    std::vector<fs::path> modules;
    for (const char* name : {"blur", "curve", "faulty", "gauge", "grown", "many", "pack", "plain_c", "sneaky",
                             "shift", "split", "tint", "unknown_words", "wrong_major"}) {
        modules.push_back(fixture(name));
    }
    const fs::path plugins = fs::path(POSTFX_BUILD_DIRECTORY) / "postfx_plugins";
    if (fs::is_directory(plugins)) {
        for (const auto& entry : fs::directory_iterator(plugins)) {
            if (entry.path().extension() == ".so") modules.push_back(entry.path());
        }
    }
    return modules;
}

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

/// Where `word` stands in `text` with no letter or digit beside it, so that glow_down and GLOW_TAPS count for
/// "glow"; npos if nowhere.
std::size_t find_name(std::string_view text, std::string_view word) {
    const auto outside = [&](std::size_t at) {
        return at >= text.size() || !std::isalnum(static_cast<unsigned char>(text[at]));
    };
    for (std::size_t at = 0; (at = text.find(word, at)) != std::string::npos; ++at) {
        if (outside(at - 1) && outside(at + word.size())) return at; // at - 1 wraps beyond the end at 0
    }
    return std::string::npos;
}

/// What `text`, which lies in `folder`, includes besides files of that folder itself (in quotes) and the machinery of truths,
/// the framework, libraries (in angles).
std::vector<std::string> includes_beyond(const fs::path& folder, const std::string& text) {
    static const std::regex include("#[ \\t]*include[ \\t]*([\"<]?)([^\">\\n]*)");
    std::vector<std::string> beyond;
    for (std::sregex_iterator found(text.begin(), text.end(), include), end; found != end; ++found) {
        const std::string quote = (*found)[1], name = (*found)[2];
        const bool own = quote == "\"" && name.find('/') == std::string::npos && fs::exists(folder / name);
        const bool others = quote == "<" && name.find("..") == std::string::npos && !name.starts_with('/')
                            && name.find("plugins/") == std::string::npos
                            && !name.starts_with("postfx/plugin.")
                            && !fs::exists(folder.parent_path() / name);
        if (!own && !others) beyond.push_back(name);
    }
    return beyond;
}

} // namespace

TEST_CASE("a plugin exports postfx_module_v1 and nothing else") {
    for (const fs::path& module : built_plugins()) {
        INFO(module);
        const std::vector<Symbol> symbols = exported(module);
        REQUIRE(symbols.size() == 1);
        CHECK(symbols[0].name == "postfx_module_v1");
        // Constant data, 'R' where nothing in it is relocated and 'D' where pointers are.
        CHECK(std::string("RDB").find(symbols[0].type) != std::string::npos);
    }
}

TEST_CASE("names are found as words") {
    CHECK(find_name("a glow here", "glow") == 2);
    CHECK(find_name("glow", "glow") == 0);
    CHECK(find_name("glow_down.glsl", "glow") == 0);
    CHECK(find_name("the_glow", "glow") == 4);
    CHECK(find_name("glowing afterglow", "glow") == std::string::npos);
}

TEST_CASE("framework and host name no effect") {
    const fs::path source(POSTFX_SOURCE_DIRECTORY);
    std::vector<std::string> effects;
    for (const auto& folder : fs::directory_iterator(source / "plugins")) {
        if (folder.is_directory()) effects.push_back(lower(folder.path().filename().string()));
    }
    std::vector<fs::path> files = {source / "configs/study.yaml"};
    for (const char* room : {"framework", "host", "shaders", "cmake", "tests/harness",
                             "tests/framework/fixtures", "tests/truths"}) {
        for (const auto& entry : fs::recursive_directory_iterator(source / room)) {
            if (entry.is_regular_file()) files.push_back(entry.path());
        }
    }
    for (const fs::path& file : files) {
        const std::string text = lower(postfx::testing::file_bytes(file));
        for (const std::string& effect : effects) {
            const std::size_t at = find_name(text, effect);
            if (at == std::string::npos) continue;
            const auto line =
                1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
            FAIL_CHECK(file.string() << ":" << line << " names the effect " << effect);
        }
    }
}

TEST_CASE("what lies beyond a truth's folder is found") {
    const postfx::testing::TemporaryDirectory effect;
    fs::create_directory(effect / "truth");
    std::ofstream(effect / "exact_glow.hpp") << "// the effect's\n";
    std::ofstream(effect / "truth/lens.hpp") << "// the truth's\n";
    const auto beyond = [&](const std::string& text) { return includes_beyond(effect / "truth", text); };
    CHECK(beyond("#include \"lens.hpp\"\n#include <truths/truth.hpp>\n#include <cmath>\n").empty());
    for (const char* wrong :
         {"#include \"../exact_glow.hpp\"", "#include \"exact_glow.hpp\"", "#include <exact_glow.hpp>",
          "# include <../exact_glow.hpp>", "#include \"truth/../../exact_glow.hpp\"",
          "#include <postfx/plugin.hpp>", "#include <postfx/plugin.h>", "#include </glow/exact_glow.hpp>",
          "#include <plugins/glow/exact_glow.hpp>", "#include GLOW"}) {
        INFO(wrong);
        CHECK(beyond(std::string("#include <cmath>\n") + wrong + "\n").size() == 1);
    }
}

TEST_CASE("a truth includes nothing of its effect") {
    int files = 0;
    for (const auto& effect : fs::directory_iterator(fs::path(POSTFX_SOURCE_DIRECTORY) / "plugins")) {
        const fs::path folder = effect.path() / "truth";
        if (!fs::is_directory(folder)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(folder)) {
            INFO(entry.path());
            REQUIRE(entry.is_regular_file()); // a folder within would be built by nobody
            CHECK(includes_beyond(folder, postfx::testing::file_bytes(entry.path()))
                  == std::vector<std::string>{});
            ++files;
        }
    }
    CHECK(files > 0);
}
