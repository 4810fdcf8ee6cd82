// postfx render: a scene through a chain to a picture or a numbered sequence.
#include "command.hpp"
#include "options.hpp"
#include "report_options.hpp"
#include "scene_options.hpp"

#include "budget/met_budget.hpp"
#include "measure/level_trial.hpp"
#include "run/chain_runner.hpp"
#include "run/gl_session.hpp"
#include "run/picture_file.hpp"
#include "run/scene_view.hpp"
#include "terminal/progress_bar.hpp"

#include <gl/objects.hpp>
#include <image/files.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>

namespace fs = std::filesystem;

namespace postfx::host {
namespace {

/// "name.png" -> "name_0007.png"; pictures on standard output just follow each other.
fs::path numbered(const fs::path& file, int frame, int frames) {
    if (file == "-") return file;
    const std::size_t digits = std::max<std::size_t>(4, std::to_string(frames - 1).size());
    return file.parent_path()
           / fmt::format("{}_{:0{}}{}", file.stem().string(), frame, digits, file.extension().string());
}

class RenderCommand : public Command {
public:
    void declare(CLI::App& app) override {
        scene_options_.declare(app);
        chain_options_.declare(app);
        output_options_.declare(
            app,
            "Picture: .png (8 bit, dithered), .exr, .hdr, .pfm (float; scene-linear unless the chain tone "
            "maps). Of a sequence: FILE_0000.png ...");
        app.add_option("--frames", frames_, "Length of a sequence; 1 = one picture")
            ->check(CLI::Range(1, 1000000))
            ->capture_default_str();
        app.add_option("--fps", fps_, "Frames per second of a sequence")
            ->check(CLI::PositiveNumber)
            ->capture_default_str();
        app.add_option("--save", save_,
                       fmt::format("Write attachments too: depth=FILE,normal=FILE,... ({}); "
                                   "depth in metres along the view axis, 0 = nothing there",
                                   fmt::join(attachment_names(), ", ")))
            ->type_name("NAME=FILE")
            ->default_str("")
            ->delimiter(',');
        app.add_option("--working", working_, "Format of working targets")
            ->check(CLI::IsMember({"rgba16f", "rgba32f"}))
            ->capture_default_str();
        app.add_option("--samples", samples_, "Of the scene per pixel: 4 smooths edges, 1 is quicker")
            ->check(CLI::IsMember({1, 4}))
            ->capture_default_str();
        app.add_option("--seed", seed_, "Seed of all noise")->capture_default_str();
        catalog_options_.declare(app);
        report_options_.declare(app);
    }

    Status run() override {
        read_saves();
        output_ = output_options_.file();
        const Catalog catalog = catalog_options_.load();
        Chain chain = chain_options_.read(catalog);
        const Scene scene = scene_options_.open();
        ViewBounds bounds(scene);
        const SceneFacts facts = scene_options_.facts(scene, bounds);
        PlanOptions options = scene_options_.plan_options(output_for(output_));
        options.working_format = *format_by_name(working_);

        const GlSession session;
        SceneRenderer renderer(scene, {.samples = samples_});
        const std::optional<MetBudget> budget =
            meet_budget(chain, facts, options, chain_options_.budget_source(),
                        trial_inputs(renderer, facts, scene_options_.time()));
        ChainRunner runner(std::move(chain), facts, options, SceneRenderer::attachment_formats());
        ProgressBar progress("rendering", frames_);
        for (int i = 0; i < frames_; ++i) {
            render_frame(renderer, runner, bounds, i);
            progress.advance();
        }
        report_options_.tell(runner.executor().report(), budget, output_of(frames_ - 1));
        return Status::success;
    }

private:
    PictureFile output_of(int frame) const {
        return {frames_ == 1 ? output_.path : numbered(output_.path, frame, frames_), output_.kind};
    }

    void render_frame(SceneRenderer& renderer, ChainRunner& runner, ViewBounds& bounds, int index) {
        FrameInputs frame;
        frame.time = scene_options_.time() + index / fps_;
        frame.frame = static_cast<std::uint32_t>(index);
        frame.seed = seed_;
        if (index > 0) {
            SceneFacts facts = runner.facts();
            look(facts, bounds, renderer.scene().camera_at(frame.time), frame.time);
            runner.replan(facts);
        }
        const SceneFacts& facts = runner.facts();
        frame.camera = facts.camera;
        std::vector<std::string> wanted = runner.attachments();
        for (const auto& [name, file] : saves_) {
            if (std::find(wanted.begin(), wanted.end(), name) == wanted.end()) wanted.push_back(name);
        }
        const Textures textures = textures_of(renderer.render(facts.width, facts.height, frame.time, wanted));
        runner.run(textures, frame, Timing::off, report_options_.watch());
        write_picture(runner, output_of(index));
        for (const auto& [name, file] : saves_) {
            save_attachment(textures.at(name), name, frames_ == 1 ? file : numbered(file, index, frames_),
                            facts);
        }
        // The first draw of a program compiles it on some drivers, so that costs are told of a second one.
        if (report_options_.wants_times() && index == frames_ - 1)
            runner.run(textures, frame, Timing::profile, report_options_.watch());
    }

    static void save_attachment(std::uint32_t texture, const std::string& name, const fs::path& file,
                                const SceneFacts& facts) {
        if (name != "depth") {
            const Image image = gl::read_texture(texture, facts.width, facts.height, Format::rgba32f);
            Image rgb(image.width, image.height, 3);
            for (std::size_t i = 0; i < image.pixel_count(); ++i) {
                std::copy_n(&image.values[4 * i], 3, &rgb.values[3 * i]);
            }
            write_image(file, rgb);
            return;
        }
        Image depth = gl::read_texture(texture, facts.width, facts.height, Format::depth32f);
        for (float& value : depth.values) {
            const bool nothing = value == static_cast<float>(facts.camera.sky_depth);
            value = nothing ? 0.0f : static_cast<float>(facts.camera.view_z(value));
        }
        write_image(file, depth);
    }

    void read_saves() {
        for (const std::string& item : save_) {
            const std::size_t equals = item.find('=');
            const std::string name = item.substr(0, equals);
            const std::vector<std::string> names = attachment_names();
            if (equals == std::string::npos || std::find(names.begin(), names.end(), name) == names.end()) {
                throw Error(fmt::format("--save \"{}\" is not NAME=FILE with NAME one of {}{}", item,
                                        fmt::join(names, ", "), did_you_mean(name, names)));
            }
            saves_[name] = item.substr(equals + 1);
            check_writable_kind(saves_[name]);
            check_output_folder(saves_[name]); // before anything slow
        }
    }

    SceneOptions scene_options_;
    ChainOptions chain_options_{"cinematic"};
    CatalogOptions catalog_options_;
    ReportOptions report_options_;
    OutputOptions output_options_;
    PictureFile output_;
    std::string working_ = "rgba16f";
    std::vector<std::string> save_;
    std::map<std::string, fs::path> saves_;
    int frames_ = 1, samples_ = 4;
    double fps_ = 30;
    std::uint32_t seed_ = 0;
};

const Register<RenderCommand> registered("render", "Render a scene through a chain");

} // namespace
} // namespace postfx::host
