// The table of rooms in docs/architecture.md says what the folders and CMake say.
#include <temporary_directory.hpp>

#include <catch2/catch.hpp>

#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace fs = std::filesystem;

namespace {

const fs::path source = POSTFX_SOURCE_DIRECTORY;

using Names = std::set<std::string>;

Names words_of(const std::string& text) {
    static const std::regex word("[a-z_]+");
    Names words;
    for (std::sregex_iterator found(text.begin(), text.end(), word), end; found != end; ++found)
        words.insert(found->str());
    return words;
}

/// Of each room below `parent` what it may use, as the table has it.
std::map<std::string, Names> rooms_in_table(const std::string& parent) {
    std::map<std::string, Names> rooms;
    std::istringstream lines(postfx::testing::file_bytes(source / "docs/architecture.md"));
    const std::regex row("\\| `" + parent + "/([a-z]+)/` \\|.*\\| ([^|]*) \\|");
    std::smatch found;
    for (std::string line; std::getline(lines, line);) {
        if (std::regex_match(line, found, row)) rooms[found[1]] = words_of(found[2]);
    }
    return rooms;
}

Names folders_in(const fs::path& parent) {
    Names names;
    for (const auto& entry : fs::directory_iterator(parent)) {
        if (entry.is_directory()) names.insert(entry.path().filename().string());
    }
    return names;
}

/// Of our libraries, what a call of a CMake file links: the arguments behind the room's name, and PUBLIC ones.
std::map<std::string, Names> links_in(const fs::path& file, const std::string& call) {
    static const std::regex library("postfx_(?:host_)?([a-z]+)|\\bpostfx\\b");
    const std::string text = postfx::testing::file_bytes(file);
    const std::regex line("\n" + call + "\\(([a-z]+)([^)]*)\\)");
    std::map<std::string, Names> links;
    for (std::sregex_iterator found(text.begin(), text.end(), line), end; found != end; ++found) {
        Names& names = links[(*found)[1]];
        const std::string arguments = (*found)[2];
        for (std::sregex_iterator name(arguments.begin(), arguments.end(), library); name != end; ++name)
            names.insert((*name)[1].matched ? (*name)[1].str() : "framework");
        names.erase("glad"); // generated, no room
    }
    return links;
}

} // namespace

TEST_CASE("The table of rooms has every folder and no other") {
    for (const std::string parent : {"framework/src", "host"}) {
        INFO(parent);
        Names in_table;
        for (const auto& [room, uses] : rooms_in_table(parent))
            in_table.insert(room);
        CHECK(in_table == folders_in(source / parent));
    }
}

TEST_CASE("What a room may use is what it links") {
    std::map<std::string, Names> framework = rooms_in_table("framework/src");
    CHECK(links_in(source / "framework/CMakeLists.txt", "postfx_room") == framework);
    const std::map<std::string, Names> host = rooms_in_table("host");
    const auto linked = links_in(source / "host/CMakeLists.txt", "postfx_host_room");
    REQUIRE(linked.size() >= 6); // the others have CMake files or are the program's
    for (const auto& [room, links] : linked) {
        INFO(room);
        CHECK(links == host.at(room));
    }
}

TEST_CASE("At the root of host there is main alone") {
    for (const auto& entry : fs::directory_iterator(source / "host")) {
        INFO(entry.path());
        const std::string name = entry.path().filename().string();
        CHECK((entry.is_directory() || name == "main.cpp" || name == "CMakeLists.txt"));
    }
}
