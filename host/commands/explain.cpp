// postfx explain: the plan, without drawing anything.
#include "command.hpp"
#include "options.hpp"
#include "picture.hpp"
#include "scene_input.hpp"

#include <postfx/postfx.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace postfx::host {
namespace {

class ExplainCommand : public Command {
public:
    void declare(CLI::App& app) override {
        scene_options_.declare(app);
        chain_options_.declare(app);
        catalog_options_.declare(app);
        app.add_option("-o,--output", output_, "Plan for this file's kind: .png for display, others linear")
            ->capture_default_str()
            ->type_name("FILE");
        app.add_flag("--json", json_, "As JSON");
        app.add_option("--shader", shader_, "Print the generated shader of this pass instead")
            ->type_name("PASS");
    }

    Status run() override {
        const Catalog catalog = catalog_options_.load();
        const Chain chain = chain_options_.read(catalog);
        const Scene scene = scene_options_.open();
        const Facts facts = scene_options_.facts(scene, scene_options_.time(), output_for(output_));
        const Plan plan = Planner().plan(chain, facts);
        if (!shader_.empty()) return print_shader(plan);
        Report report = describe(plan);
        report.clock = "none: explain draws nothing";
        if (json_) {
            fmt::print("{}\n", report_json(report));
        } else {
            fmt::print("{}attachments rendered: {}\n", report_text(report),
                       fmt::join(plan.attachments, ", "));
        }
        return Status::success;
    }

private:
    Status print_shader(const Plan& plan) const {
        std::vector<std::string> names;
        for (const Pass& pass : plan.passes) {
            if (pass.name == shader_) {
                for (std::size_t i = 0; i < pass.program->files.size(); ++i) {
                    fmt::print("// source string {}: {}\n", i, pass.program->files[i]);
                }
                fmt::print("{}", pass.program->text);
                return Status::success;
            }
            names.push_back(pass.name);
        }
        throw Error(fmt::format("the plan has no pass \"{}\"{}; there are: {}", shader_,
                                did_you_mean(shader_, names), fmt::join(names, ", ")));
    }

    SceneOptions scene_options_;
    ChainOptions chain_options_{"cinematic"};
    CatalogOptions catalog_options_;
    std::string output_ = "picture.png", shader_;
    bool json_ = false;
};

const Register<ExplainCommand> registered("explain", "Tell what a chain would do, and why");

} // namespace
} // namespace postfx::host
