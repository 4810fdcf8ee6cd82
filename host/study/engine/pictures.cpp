#include "pictures.hpp"

#include "measure/truth_store.hpp"
#include "terminal/interruption.hpp"
#include "truths/drawn_scene.hpp"

#include <image/flip.hpp>
#include <image/metrics.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace postfx::host::study {
namespace {

Chain chain_of(const ChainEntry& entry) {
    Chain chain;
    chain.entries.push_back(entry);
    return chain;
}

int samples_of(const RegisteredTruth& truth, const TruthOptions& options) {
    if (options.samples > 0) return options.samples;
    // Truths of a few samples are exact: there is nothing to save.
    constexpr int few = 16;
    if (truth.samples <= few) return truth.samples;
    return std::max(few, static_cast<int>(truth.samples * options.share) / 2 * 2);
}

SummedTruth sum_up_truth(const RegisteredTruth& registered, const TruthRequest& request,
                         const TruthOptions& options) {
    TruthRun run(registered, request, samples_of(registered, options));
    const std::filesystem::path file = options.store / run.file_name();
    run.resume(file);
    sum_up(run, file,
           fmt::format("{} in {}, truth ({})", registered.effect, request.scene.name, registered.kind));
    if (!run.complete()) throw Interrupted();
    TruthResult result = run.result();
    return {{.kind = registered.kind,
             .description = result.description,
             .samples = result.samples,
             .own_error = result.own_error,
             .statistics = registered.compared == RegisteredTruth::Compared::statistics},
            std::move(result.picture)};
}

/// A level on pictures of a metric's making.
class DrawnMethod : public Method {
public:
    explicit DrawnMethod(ChainEntry entry) : entry_(std::move(entry)) {}
    const ChainEntry& entry() const override { return entry_; }

    Image64 draw(const ChainEntry& entry, const MethodInput& input) const override {
        SceneFacts facts;
        facts.width = input.color.width;
        facts.height = input.color.height;
        facts.camera = input.camera;
        std::vector<gl::Texture> owned;
        Textures textures;
        const auto upload = [&](const std::string& name, const Image& image) {
            if (image.width != facts.width || image.height != facts.height)
                throw Error(fmt::format("the metric's \"{}\" is {}x{}, its color {}x{}", name, image.width,
                                        image.height, facts.width, facts.height));
            owned.emplace_back(image.width, image.height, format_for(image));
            owned.back().upload(image);
            textures[name] = owned.back().name();
        };
        upload("color", input.color);
        for (const auto& [name, image] : input.attachments) {
            upload(name, image);
            facts.attachments.push_back(name);
        }
        FrameInputs frame;
        frame.camera = input.camera;
        frame.time = input.time;
        frame.frame = input.frame;
        ChainRunner runner(chain_of(entry), facts,
                           {.output = Output::linear, .working_format = Format::rgba32f});
        runner.run(textures, frame, Timing::off);
        return light_of(runner.executor().read_picture());
    }

private:
    static Format format_for(const Image& image) {
        return image.channels == 1 ? Format::r32f : image.channels == 2 ? Format::rg32f : Format::rgba32f;
    }

    ChainEntry entry_;
};

} // namespace

LevelPicture picture_of(const ChainEntry& entry, const View& view) {
    ChainRunner runner(chain_of(entry), view.facts(), {.output = Output::linear});
    runner.run(view.textures(), view.frame(), Timing::off);
    LevelPicture picture{.light = light_of(runner.executor().read_picture()), .skipped = ""};
    const PlannedEffect effect = runner.executor().report().effects.front();
    if (effect.status == EffectStatus::skipped) picture.skipped = effect.reason;
    return picture;
}

const SummedTruth* Truths::find(const std::string& kind) const {
    const auto found = std::find_if(summed.begin(), summed.end(),
                                    [&](const SummedTruth& truth) { return truth.facts.kind == kind; });
    return found == summed.end() ? nullptr : &*found;
}

std::vector<const RegisteredTruth*> truths_of(const std::string& effect) {
    std::vector<const RegisteredTruth*> found;
    for (const RegisteredTruth& truth : registered_truths()) {
        if (truth.effect == effect) found.push_back(&truth);
    }
    // "scene" before "layer", whatever order they were linked in.
    std::sort(found.begin(), found.end(), [](const auto* a, const auto* b) { return a->kind > b->kind; });
    return found;
}

Truths sum_up_truths(const std::vector<const RegisteredTruth*>& registered, const Scene& scene,
                     const View& view, const ChainEntry& entry, const TruthOptions& options) {
    Truths truths;
    const TruthRequest request{.scene = scene,
                               .width = view.size().width,
                               .height = view.size().height,
                               .entry = entry,
                               .given = view.given()};
    for (const RegisteredTruth* truth : registered) {
        try {
            truths.summed.push_back(sum_up_truth(*truth, request, options));
        } catch (const Error& error) {
            truths.missing[truth->kind] = error.what();
        }
    }
    return truths;
}

PictureError error_of(const Image64& picture, const Image64& truth, const View& view) {
    return {relative_error(picture, truth).relative_rmse, mean_of(flip_map(picture, truth, view))};
}

Image flip_map(const Image64& picture, const Image64& truth, const View& view) {
    return flip(convert<float>(view.shown(truth)), convert<float>(view.shown(picture)), Encoding::linear).map;
}

double mean_of(const Image& map) {
    double sum = 0;
    for (const float value : map.values)
        sum += value;
    return sum / static_cast<double>(std::max<std::size_t>(map.values.size(), 1));
}

std::vector<MetricFacts> metrics_of(const std::string& effect) {
    std::vector<MetricFacts> facts;
    for (const RegisteredMetric& metric : registered_metrics()) {
        if (metric.effect == effect)
            facts.push_back({metric.name, metric.unit, metric.help, metric.stands_for_error});
    }
    std::sort(facts.begin(), facts.end(), [](const auto& a, const auto& b) { return a.name < b.name; });
    return facts;
}

std::vector<double> measure_metrics(const std::vector<MetricFacts>& metrics, const ChainEntry& entry,
                                    std::vector<std::string>& notes) {
    std::vector<double> values;
    const DrawnMethod method(entry);
    for (const MetricFacts& facts : metrics) {
        StopOnInterrupt::check();
        const auto metric = std::find_if(
            registered_metrics().begin(), registered_metrics().end(), [&](const RegisteredMetric& candidate) {
                return candidate.effect == entry.effect->id && candidate.name == facts.name;
            });
        try {
            values.push_back(metric->measure(method));
        } catch (const Error& error) {
            values.push_back(std::numeric_limits<double>::quiet_NaN());
            const std::string level =
                entry.effect->levels.empty() ? "" : " of " + entry.effect->levels[entry.level].id;
            notes.push_back(fmt::format("{}{} could not be measured: {}", facts.name, level, error.what()));
        }
    }
    return values;
}

} // namespace postfx::host::study
