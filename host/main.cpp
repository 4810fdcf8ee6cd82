// The program `postfx`: finds the subcommand, runs it, turns errors into one line and a status.
#include "commands/command.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <iterator>

namespace postfx::host {

std::vector<RegisteredCommand>& registered_commands() {
    static std::vector<RegisteredCommand> commands;
    return commands;
}

namespace {

constexpr int bad_input = 2, broken = 3;

/// The word itself, or the present name of the command that it was.
std::string present_name(const std::string& word) {
    for (const RegisteredCommand& command : registered_commands()) {
        if (command.former_name.empty() || command.former_name != word) continue;
        fmt::print(stderr, "postfx: {} is called {} now\n", word, command.name);
        return command.name;
    }
    return word;
}

/// CLI11 would say only that a subcommand is required.
void check_command(const std::string& word) {
    std::vector<std::string> names;
    for (const RegisteredCommand& command : registered_commands())
        names.push_back(command.name);
    if (word.starts_with('-') || std::find(names.begin(), names.end(), word) != names.end()) return;
    throw Error(
        fmt::format("no command \"{}\"{} (postfx --help tells them all)", word, did_you_mean(word, names)));
}

std::string failure_message(const CLI::App*, const CLI::Error& error) {
    return fmt::format("postfx: {} (--help tells more)\n", error.what());
}

int run(int argc, char** argv) {
    CLI::App app("postfx: scenes and images through chains of post-processing effects", "postfx");
    app.require_subcommand(1);
    app.set_version_flag("--version", POSTFX_VERSION);
    app.footer("postfx COMMAND --help tells a command's options.\n"
               "Status: 0 done, 1 pictures differ (diff), 2 bad input, 3 a bug in postfx.");

    std::vector<RegisteredCommand>& commands = registered_commands();
    std::sort(commands.begin(), commands.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    std::vector<std::unique_ptr<Command>> made;
    for (const RegisteredCommand& command : commands) {
        made.push_back(command.make());
        CLI::App* sub = app.add_subcommand(command.name, command.help);
        sub->option_defaults()->always_capture_default();
        made.back()->declare(*sub);
    }
    app.failure_message(failure_message);
    // As CLI11 takes them: the last first, without the program.
    std::vector<std::string> words(std::make_reverse_iterator(argv + argc),
                                   std::make_reverse_iterator(argv + 1));
    if (!words.empty()) {
        words.back() = present_name(words.back());
        check_command(words.back());
    }
    try {
        app.parse(words);
    } catch (const CLI::ParseError& error) {
        const int status = app.exit(error);
        return status == 0 ? 0 : bad_input;
    }
    for (std::size_t i = 0; i < commands.size(); ++i) {
        if (app.got_subcommand(commands[i].name)) return static_cast<int>(made[i]->run());
    }
    return bad_input;
}

} // namespace
} // namespace postfx::host

int main(int argc, char** argv) {
    try {
        return postfx::host::run(argc, argv);
    } catch (const postfx::Error& error) {
        fmt::print(stderr, "postfx: {}\n", error.what());
        return postfx::host::bad_input;
    } catch (const std::exception& error) {
        fmt::print(stderr, "postfx: internal error: {}\n", error.what());
        return postfx::host::broken;
    }
}
