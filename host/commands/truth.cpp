// postfx truth: what an effect ought to give, slowly and by other means.
#include "command.hpp"
#include "options.hpp"

#include "input/open_scene.hpp"
#include "measure/truth_store.hpp"
#include "run/gl_session.hpp"
#include "run/scene_view.hpp"
#include "terminal/effect_text.hpp"
#include "terminal/interruption.hpp"
#include "terminal/number_checks.hpp"

#include <image/files.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace fs = std::filesystem;

namespace postfx::host {
namespace {

std::string list_of_truths() {
    std::vector<std::string> lines;
    for (const RegisteredTruth& truth : registered_truths())
        lines.push_back(fmt::format("{} ({}): {}", truth.effect, truth.kind, truth.help));
    std::sort(lines.begin(), lines.end());
    return fmt::format("There are truths of\n  {}\n", fmt::join(lines, "\n  "));
}

class TruthCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("SCENE", scene_,
                       "A name from configs/scenes/, a scene file, or a model (glTF, OBJ, ...)")
            ->required();
        app.add_option("EFFECT", effect_, "An effect, or as in a chain file: 'glow: {intensity: 0.2}'")
            ->required();
        app.add_option("--kind", kind_,
                       "scene: the phenomenon itself; layer: the best that the effect's own inputs allow")
            ->check(CLI::IsMember({"scene", "layer"}))
            ->capture_default_str();
        app.add_option("--set", values_, "A value of the effect (repeatable)")
            ->type_name("NAME=VALUE")
            ->default_str("")
            ->allow_extra_args(false);
        app.add_option("--size", size_, "Of the picture, pixels")->type_name("WxH")->capture_default_str();
        app.add_option("--time", time_, "Seconds after the scene's start")
            ->check(finite())
            ->capture_default_str();
        app.add_option("--samples", samples_, "Of the truth, an even number; its own default without")
            ->check(CLI::Range(2, 1 << 24))
            ->type_name("N")
            ->default_str("");
        app.add_option("--scene-samples", scene_samples_,
                       "Of the scene per pixel, as in the pictures that are to be compared")
            ->check(CLI::IsMember({1, 4}))
            ->capture_default_str();
        app.add_option("-o,--output", output_,
                       "Picture: .exr, .pfm, .hdr (scene-linear) or .png; - is standard output, where text "
                       "goes to stderr then")
            ->type_name("FILE");
        app.add_option("--format", format_,
                       "Kind of picture, whatever FILE is called: png, jpg, exr, hdr or pfm")
            ->type_name("KIND")
            ->default_str("");
        app.add_option("--store", store_, "Where sums are kept; truths/ in the user's cache without")
            ->type_name("DIR")
            ->default_str("");
        app.add_flag("--fresh", fresh_, "Begin again, whatever is kept");
        app.add_flag("--json", json_, "As JSON");
        catalog_options_.declare(app);
        app.footer(list_of_truths()
                   + "Sums are kept while they grow: a command that was stopped (Ctrl-C) goes on when it is "
                     "given again, and\n"
                     "one that had ended is answered at once.\n"
                     "own_error: root mean square of the truth's own error, as two halves of its samples "
                     "tell it, as a share of\n"
                     "the picture's root mean square.\n"
                     "JSON: {effect, kind, scene, size, description, samples, own_error, root_mean_square, "
                     "sums, output}; own_error is\n"
                     "null below two samples.\n"
                     "Status: 0 done, 2 bad input, 130 stopped before the last sample (a picture so far is "
                     "written).");
    }

    Status run() override {
        if (!output_.empty()) picture_file(output_, format_);
        const Catalog catalog = catalog_options_.load();
        const TruthRequest request = read_request(catalog);
        const RegisteredTruth& registered = find_truth(request.entry.effect->id, kind_);

        const GlSession session;
        TruthRun run(registered, request, samples_ > 0 ? samples_ : registered.samples);
        const fs::path file = truth_store(store_) / run.file_name();
        if (!fresh_) run.resume(file);
        const StopOnInterrupt guard;
        sum_up(run, file, "truth");
        if (run.done() == 0) return Status::interrupted;
        tell(run.result(), request, file);
        if (run.complete()) return Status::success;
        fmt::print(stderr, "postfx: stopped at {} of {} samples; the same command goes on from there\n",
                   run.done(), run.samples());
        return Status::interrupted;
    }

private:
    TruthRequest read_request(const Catalog& catalog) const {
        Chain chain;
        parse_chain_entry(effect_text(), "EFFECT", catalog, chain);
        const Size size = parse_size(size_);
        return {.scene = open_known_scene(scene_),
                .time = time_,
                .width = size.width,
                .height = size.height,
                .scene_samples = scene_samples_,
                .entry = std::move(chain.entries.at(0))};
    }

    /// --set a=1 --set b=2 as a chain file has it.
    std::string effect_text() const {
        if (values_.empty()) return effect_;
        if (effect_.find_first_of(":{") != std::string::npos)
            throw Error("values are given by --set or in EFFECT's own {}, not both");
        std::vector<std::string> values;
        for (const std::string& value : values_) {
            const std::size_t equals = value.find('=');
            if (equals == std::string::npos)
                throw Error(fmt::format("--set \"{}\" is not NAME=VALUE, such as radius=0.5", value));
            values.push_back(fmt::format("{}: {}", value.substr(0, equals), value.substr(equals + 1)));
        }
        return fmt::format("{}: {{{}}}", effect_, fmt::join(values, ", "));
    }

    void tell(const TruthResult& result, const TruthRequest& request, const fs::path& sums) const {
        if (!output_.empty()) write_image(output_, convert<float>(result.picture), {.kind = format_});
        std::FILE* const text = output_ == "-" ? stderr : stdout;
        if (!json_) {
            fmt::print(text, "{} of {}, {}: {}\n", request.entry.effect->id, request.scene.name, kind_,
                       result.description);
            fmt::print(text, "  own error {:.3g}, root mean square {:.6g}\n", result.own_error,
                       result.root_mean_square);
            if (!output_.empty()) fmt::print(text, "  wrote {}\n", output_);
            return;
        }
        const Json json = {
            {"effect", request.entry.effect->id},
            {"kind", kind_},
            {"scene", request.scene.name},
            {"size", fmt::format("{}x{}", request.width, request.height)},
            {"description", result.description},
            {"samples", result.samples},
            {"own_error", std::isfinite(result.own_error) ? Json(result.own_error) : Json()},
            {"root_mean_square", result.root_mean_square},
            {"sums", sums.string()},
            {"output", output_.empty() ? Json() : Json(output_)},
        };
        fmt::print(text, "{}\n", json.dump(2));
    }

    CatalogOptions catalog_options_;
    std::string scene_, effect_, kind_ = "scene", size_ = "480x270", output_, store_, format_;
    std::vector<std::string> values_;
    double time_ = 0;
    int samples_ = 0, scene_samples_ = 4;
    bool fresh_ = false, json_ = false;
};

const Register<TruthCommand> registered("truth", "What an effect ought to give, found slowly by other means");

} // namespace
} // namespace postfx::host
