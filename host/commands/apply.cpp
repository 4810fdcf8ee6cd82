// postfx apply: a chain on images that someone else made.
#include "command.hpp"
#include "options.hpp"
#include "report_options.hpp"

#include "budget/met_budget.hpp"
#include "input/picture_input.hpp"
#include "run/chain_runner.hpp"
#include "run/gl_session.hpp"
#include "run/picture_file.hpp"
#include "run/scene_view.hpp"
#include "terminal/number_checks.hpp"
#include "terminal/warnings.hpp"

#include <gl/objects.hpp>
#include <image/alpha.hpp>

#include <fmt/format.h>

#include <map>

namespace postfx::host {
namespace {

/// How a file of that kind has its alpha when nothing else is said: as its format's documentation has it.
Coding::Alpha usual_alpha(const PictureFile& file) {
    const std::string kind = written_kind(file.path, file.kind);
    if (kind == "exr") return Coding::Alpha::premultiplied;
    return kind == "png" ? Coding::Alpha::straight : Coding::Alpha::none;
}

/// Does any pixel of this picture of four channels let something through?
bool is_transparent(const Image& image) {
    for (std::size_t i = 3; i < image.values.size(); i += 4)
        if (image.values[i] != 1) return true;
    return false;
}

class ApplyCommand : public Command {
public:
    void declare(CLI::App& app) override {
        picture_options_.declare(app);
        output_options_.declare(app, "Result: .png, .jpg (display), .exr, .hdr, .pfm (linear)");
        app.add_option("--alpha", alpha_,
                       "Of the result: premultiplied (default for .exr), straight (default for .png) or drop")
            ->check(CLI::IsMember({"premultiplied", "straight", "drop"}))
            ->default_str("");
        app.add_option("--working", working_, "Format of working targets")
            ->check(CLI::IsMember({"rgba16f", "rgba32f"}))
            ->capture_default_str();
        app.add_option("--time", time_, "Seconds")->check(finite())->capture_default_str();
        app.add_option("--frame", frame_, "Frame number: noise depends on it")->capture_default_str();
        app.add_option("--seed", seed_, "Seed of all noise")->capture_default_str();
        app.add_flag("--no-fuse", no_fuse_, "Let every effect write its own target");
        chain_options_.declare(app);
        catalog_options_.declare(app);
        report_options_.declare(app);
    }

    Status run() override {
        const PictureFile output = output_options_.file();
        if (!chain_options_.given()) throw Error("nothing to apply: give --chain or --effect");
        const Catalog catalog = catalog_options_.load();
        Chain chain = chain_options_.read(catalog);

        PictureInput input = picture_options_.read(report_options_.quiet());
        const Written written = written_of(input, output);
        const SceneFacts facts = facts_of(input);
        const PlanOptions options = plan_options(output, written);
        std::map<std::string, Image>& images = input.attachments;
        images["color"] = std::move(input.color.image);

        const GlSession session;
        std::map<std::string, gl::Texture> uploaded;
        const auto upload = [&](const std::vector<std::string>& names) {
            Textures textures;
            for (const std::string& name : names)
                textures[name] = uploaded_texture(uploaded[name], images.at(name));
            return textures;
        };
        FrameInputs frame;
        frame.camera = facts.camera;
        frame.time = time_;
        frame.frame = frame_;
        frame.seed = seed_;
        const std::optional<MetBudget> budget =
            meet_budget(chain, facts, options, chain_options_.budget_source(), {upload, frame});
        ChainRunner runner(std::move(chain), facts, options, formats_of(images));
        const Textures textures = upload(runner.attachments());
        runner.run(textures, frame, Timing::off, report_options_.watch());
        tell_lines(output.path.string(), write_picture(runner, output, written), false);
        if (report_options_.wants_times())
            runner.run(textures, frame, Timing::profile, report_options_.watch());
        report_options_.tell(runner.executor().report(), budget, output);
        return Status::success;
    }

private:
    /// What becomes of the picture's alpha. Light that is to be multiplied by it is, before any effect sees it; light
    /// that is to be divided by it is divided at the very end, so that effects work on what reaches the lens.
    Written written_of(PictureInput& input, const PictureFile& output) const {
        Written written;
        if (picture_options_.carries()) written.origin = {input.source.get(), input.request};
        const Coding::Alpha had = input.color.coding.alpha;
        if (had == Coding::Alpha::none) return written;
        written.alpha_of_file = alpha_.empty()         ? usual_alpha(output)
                                : alpha_ == "drop"     ? Coding::Alpha::none
                                : alpha_ == "straight" ? Coding::Alpha::straight
                                                       : Coding::Alpha::premultiplied;
        const bool can_hold_alpha = usual_alpha(output) != Coding::Alpha::none;
        if (written.alpha_of_file != Coding::Alpha::none && !can_hold_alpha)
            throw Error(fmt::format("--alpha {}: a .{} has no alpha", alpha_,
                                    written_kind(output.path, output.kind)));
        if (!can_hold_alpha && alpha_.empty() && is_transparent(input.color.image))
            tell_or_refuse(
                output.path.string(),
                {fmt::format("a .{} has no alpha: it is left out (--alpha drop says that it may be)",
                             written_kind(output.path, output.kind))},
                picture_options_.strict());
        written.alpha_of_chain = had;
        if (had == Coding::Alpha::straight && written.alpha_of_file == Coding::Alpha::premultiplied) {
            input.color.image = with_alpha(std::move(input.color.image), had, written.alpha_of_file);
            written.alpha_of_chain = Coding::Alpha::premultiplied;
        }
        return written;
    }

    static SceneFacts facts_of(const PictureInput& input) {
        SceneFacts facts;
        facts.width = input.color.image.width;
        facts.height = input.color.image.height;
        facts.color_is_8bit = input.color.coding.plain_srgb && input.color.coding.bits == 8;
        facts.camera = input.camera;
        for (const auto& [name, image] : input.attachments)
            facts.attachments.push_back(name);
        return facts;
    }

    PlanOptions plan_options(const PictureFile& output, const Written& written) const {
        return {.output = output_for(output),
                .working_format = *format_by_name(working_),
                .divide_by_alpha = divides_by_alpha(output, written),
                .fuse = !no_fuse_};
    }

    static Format format_of(const Image& image) {
        return image.channels == 1 ? Format::r32f : Format::rgba32f;
    }

    static std::map<std::string, Format> formats_of(const std::map<std::string, Image>& images) {
        std::map<std::string, Format> formats;
        for (const auto& [name, image] : images)
            formats[name] = format_of(image);
        return formats;
    }

    /// The texture's name; it is made when it holds nothing yet.
    static std::uint32_t uploaded_texture(gl::Texture& texture, const Image& image) {
        if (texture.name() == 0) {
            texture = gl::Texture(image.width, image.height, format_of(image));
            texture.upload(image);
        }
        return texture.name();
    }

    std::string working_ = "rgba32f", alpha_;
    double time_ = 0;
    std::uint32_t frame_ = 0, seed_ = 0;
    bool no_fuse_ = false;
    PictureOptions picture_options_;
    OutputOptions output_options_;
    ChainOptions chain_options_{""};
    CatalogOptions catalog_options_;
    ReportOptions report_options_;
};

const Register<ApplyCommand> registered("apply", "Run a chain on images with or without depth");

} // namespace
} // namespace postfx::host
