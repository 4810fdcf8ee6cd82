// postfx schema: for editors that check and complete chain files.
#include "command.hpp"
#include "options.hpp"

#include <image/files.hpp>

#include <postfx/chain.hpp>

#include <fmt/format.h>

namespace postfx::host {
namespace {

class SchemaCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("-o,--output", output_, "Write it to this file instead of the terminal")
            ->type_name("FILE");
        catalog_.declare(app);
        app.footer("An editor with a YAML language server uses it when a chain file starts with\n"
                   "# yaml-language-server: $schema=FILE");
    }

    Status run() override {
        std::string schema = chain_schema(catalog_.load());
        if (!schema.ends_with('\n')) schema += '\n';
        if (output_.empty()) {
            fmt::print("{}", schema);
        } else {
            write_file_atomically(output_, schema);
        }
        return Status::success;
    }

private:
    CatalogOptions catalog_;
    std::string output_;
};

const Register<SchemaCommand> registered("schema",
                                         "Print the JSON Schema of chain files, made from the effects found");

} // namespace
} // namespace postfx::host
