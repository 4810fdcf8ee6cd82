// postfx read-model: what the program starts itself as, to read models apart from everything else. Not for users.
#include "command.hpp"

#include "input/model_process.hpp"

#include <unistd.h>

namespace postfx::host {
namespace {

class ReadModelCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.group(""); // hidden
        app.add_option("FILE", file_)->required();
    }

    Status run() override {
        read_model_for_parent(file_);
        ::_exit(0); // without the destructors of libraries that may be in disorder
    }

private:
    std::string file_;
};

const Register<ReadModelCommand> registered("read-model", "");

} // namespace
} // namespace postfx::host
