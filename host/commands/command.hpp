// A subcommand of the program. Each lives in a file of its own and registers itself; main() knows none by
// name.
#pragma once

#include <CLI/CLI.hpp>

#include <memory>
#include <string>
#include <vector>

namespace postfx::host {

/// How a command ends when nothing went wrong. Errors leave by exception: postfx::Error gives status 2.
enum class Status { success = 0, differs = 1, interrupted = 130 };

class Command {
public:
    virtual ~Command() = default;
    /// Declare options on the subcommand.
    virtual void declare(CLI::App& app) = 0;
    virtual Status run() = 0;
};

struct RegisteredCommand {
    std::string name, help;
    std::unique_ptr<Command> (*make)();
    std::string former_name; ///< is understood, with a note; "" for none
};

/// All of them, by name.
std::vector<RegisteredCommand>& registered_commands();

/// `static const Register<RenderCommand> registered("render", "Render a scene");` at the end of the command's
/// file.
template<class T>
struct Register {
    Register(std::string name, std::string help, std::string former_name = "") {
        registered_commands().push_back({std::move(name), std::move(help),
                                         []() -> std::unique_ptr<Command> { return std::make_unique<T>(); },
                                         std::move(former_name)});
    }
};

} // namespace postfx::host
