// postfx apply: a chain on images that someone else made.
#include "budget.hpp"
#include "command.hpp"
#include "depth_input.hpp"
#include "gl_session.hpp"
#include "layer_input.hpp"
#include "options.hpp"
#include "picture.hpp"
#include "report_output.hpp"
#include "warnings.hpp"

#include <gl/objects.hpp>
#include <image/files.hpp>

#include <fmt/format.h>

#include <map>

namespace postfx::host {
namespace {

/// Four channels; what is missing is 0, alpha 1.
Image widened(const Image& image) {
    Image result(image.width, image.height, 4, 0.0f);
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        for (int c = 0; c < 3; ++c) {
            const bool grey = image.channels < 3;
            result.values[4 * i + c] = image.values[image.channels * i + (grey ? 0 : c)];
        }
        const bool has_alpha = image.channels == 4 || image.channels == 2;
        result.values[4 * i + 3] = has_alpha ? image.values[image.channels * i + image.channels - 1] : 1.0f;
    }
    return result;
}

class ApplyCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("--color", color_, "The picture (PNG, JPEG, HDR, EXR, PFM)")
            ->required()
            ->type_name("IMG");
        app.add_option("--depth", depth_, "Its depth (EXR, PFM, PNG)")->type_name("IMG");
        app.add_option("--normal", normal_, "View-space normals; PNG as 0.5 + n/2")->type_name("IMG");
        app.add_option("--emission", emission_, "Light that surfaces emit, part of the picture")
            ->type_name("IMG");
        app.add_option("--ambient", ambient_, "The picture's share that occlusion may darken")
            ->type_name("IMG");
        app.add_option("-o,--output", output_, "Result: .png (display), .exr, .hdr, .pfm (linear)")
            ->required()
            ->type_name("FILE");
        app.add_option("--working", working_, "Format of working targets")
            ->check(CLI::IsMember({"rgba16f", "rgba32f"}))
            ->capture_default_str();
        app.add_option("--time", time_, "Seconds")->capture_default_str();
        app.add_option("--frame", frame_, "Frame number: noise depends on it")->capture_default_str();
        app.add_option("--seed", seed_, "Seed of all noise")->capture_default_str();
        app.add_flag("--no-fuse", no_fuse_, "Let every effect write its own target");
        app.add_flag("--strict", strict_, "Refuse what would be brought into shape with a warning");
        layer_options_.declare(app);
        depth_options_.declare(app);
        chain_options_.declare(app);
        catalog_options_.declare(app);
        report_options_.declare(app);
    }

    Status run() override {
        Facts facts;
        facts.output = output_for(output_);
        if (!chain_options_.given()) throw Error("nothing to apply: give --chain or --effect");
        const Catalog catalog = catalog_options_.load();
        Chain chain = chain_options_.read(catalog);

        const ImageSource source = open_image(color_);
        const ImageRequest request = layer_options_.color_request();
        const ImageFile color = read_image(source, request);
        tell(color_, color);
        facts.width = color.image.width;
        facts.height = color.image.height;
        facts.color_is_8bit = color.coding.plain_srgb && color.coding.bits == 8;
        facts.camera = depth_options_.camera(facts.width, facts.height);
        facts.working_format = *format_by_name(working_);
        facts.fuse = !no_fuse_;
        facts.fold = true;
        std::map<std::string, Image> images = attachments(facts, {color_, source, color});
        for (const auto& [name, image] : images)
            facts.attachments.push_back(name);
        images["color"] = widened(color.image);

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
            meet_budget(chain, facts, chain_options_.budget_source(), {upload, frame});
        ChainRunner runner(std::move(chain), facts);
        const Textures textures = upload(runner.attachments());
        runner.run(textures, frame, Timing::off, report_options_.watch());
        const bool has_alpha = color.image.channels == 4 || color.image.channels == 2;
        const Origin origin = layer_options_.carries() ? Origin{&source, request} : Origin{};
        const std::vector<std::string> remarks =
            write_picture(runner, output_, has_alpha, {.origin = origin});
        tell_lines(output_, remarks, report_options_.quiet());
        if (report_options_.wants_times())
            runner.run(textures, frame, Timing::profile, report_options_.watch());
        report_options_.tell(runner.executor().report(), budget, output_);
        return Status::success;
    }

private:
    /// The texture's name; it is made when it holds nothing yet.
    static std::uint32_t uploaded_texture(gl::Texture& texture, const Image& image) {
        if (texture.name() == 0) {
            texture =
                gl::Texture(image.width, image.height, image.channels == 1 ? Format::r32f : Format::rgba32f);
            texture.upload(image);
        }
        return texture.name();
    }

    /// A file in a role; one that holds the colour too is read once, and gives what belongs to that.
    ImageFile read(Role role, const std::string& file, const ColorInput& color) const {
        const ImageFile read = layer_options_.read(role, file, color);
        tell(file, read);
        return read;
    }

    void tell(const std::string& file, const ImageFile& read) const {
        tell_or_refuse(file, read.warnings, strict_, report_options_.quiet());
    }

    /// Everything but the colour, as the core wants it.
    std::map<std::string, Image> attachments(const Facts& facts, const ColorInput& color) const {
        std::map<std::string, Image> images;
        if (!depth_.empty()) {
            const Image depth = read(Role::depth, depth_, color).image;
            check_size(depth, depth_, facts);
            images["depth"] = depth_options_.samples(depth, facts.camera);
        }
        if (!normal_.empty()) {
            const ImageFile file = read(Role::normal, normal_, color);
            Image normal = widened(file.image);
            check_size(normal, normal_, facts);
            if (file.coding.numbers == Coding::Numbers::codes) {
                for (float& value : normal.values)
                    value = value * 2 - 1;
            }
            images["normal"] = std::move(normal);
        }
        for (const auto& [role, file] :
             {std::pair{Role::emission, emission_}, std::pair{Role::ambient, ambient_}}) {
            if (file.empty()) continue;
            Image& image = images[name_of(role)];
            image = widened(read(role, file, color).image);
            check_size(image, file, facts);
        }
        return images;
    }

    void check_size(const Image& image, const std::string& file, const Facts& facts) const {
        if (image.width == facts.width && image.height == facts.height) return;
        throw Error(Place{.file = file}, fmt::format("is {}x{}, but {} is {}x{}", image.width, image.height,
                                                     color_, facts.width, facts.height));
    }

    std::string color_, depth_, normal_, emission_, ambient_, output_;
    std::string working_ = "rgba32f";
    double time_ = 0;
    std::uint32_t frame_ = 0, seed_ = 0;
    bool no_fuse_ = false, strict_ = false;
    LayerOptions layer_options_;
    DepthOptions depth_options_;
    ChainOptions chain_options_{""};
    CatalogOptions catalog_options_;
    ReportOptions report_options_;
};

const Register<ApplyCommand> registered("apply", "Run a chain on images with or without depth");

} // namespace
} // namespace postfx::host
