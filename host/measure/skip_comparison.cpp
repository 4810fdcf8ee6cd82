#include "skip_comparison.hpp"

#include "run/chain_runner.hpp"
#include "run/scene_view.hpp"
#include "terminal/progress_bar.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <functional>

namespace postfx::host {
namespace {

constexpr std::size_t copy_case = 0, bare_scene_case = 1;

/// Would both draw the same passes, whatever the frame holds?
bool same_work(const Plan& a, const Plan& b) {
    const auto same_pass = [](const Pass& x, const Pass& y) {
        return x.program->key == y.program->key && x.uniform_block == y.uniform_block
               && x.outputs == y.outputs && x.condition == y.condition && x.where == y.where;
    };
    return SceneRenderers::same(a.attachments, b.attachments)
           && std::equal(a.passes.begin(), a.passes.end(), b.passes.begin(), b.passes.end(), same_pass);
}

std::vector<double> sums(std::vector<double> a, const std::vector<double>& b) {
    std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::plus<>());
    return a;
}

nlohmann::ordered_json frame_json(const SkipComparison::Frame& frame, double copy_ms) {
    return {{"ms", frame.ms},
            {"chain_ms", frame.chain_ms},
            {"copies", frame.chain_ms / copy_ms},
            {"texture_bytes", frame.texture_bytes},
            {"attachments", frame.attachments}};
}

} // namespace

SkipComparison::SkipComparison(const Scene& scene, SceneFacts facts, const PlanOptions& options, double time)
    : scenes_(scene, facts.width, facts.height, time), facts_(std::move(facts)), options_(options),
      copy_(PlainPass::copy(facts_.width, facts_.height, options_.working_format)) {
    frame_.camera = facts_.camera;
    frame_.time = time;
    const std::uint32_t color = scenes_.draw({}).texture("color");
    cases_.push_back({"copy pass", [this, color] { copy_.draw(color); }});
    scene_case({});
}

std::size_t SkipComparison::scene_case(const std::vector<std::string>& attachments) {
    for (const auto& [known, index] : scene_cases_) {
        if (SceneRenderers::same(known, attachments)) return index;
    }
    Case drawn{"scene", [this, attachments] { scenes_.draw(attachments); }};
    drawn.texture_bytes = scenes_.draw(attachments).texture_bytes;
    scene_cases_.emplace_back(attachments, cases_.size());
    cases_.push_back(std::move(drawn));
    return cases_.size() - 1;
}

SkipComparison::Side SkipComparison::make_side(const Chain& chain, const std::string& name) {
    Side side{std::make_unique<ChainRunner>(chain, facts_, options_), 0, 0};
    ChainRunner* runner = side.runner.get();
    side.scene_case = scene_case(runner->attachments());
    const Textures textures = textures_of(scenes_.draw(runner->attachments()));
    side.chain_case = cases_.size();
    Case drawn{name, [this, runner, textures] { runner->run(textures, frame_, Timing::off); }};
    drawn.texture_bytes = runner->plan().texture_bytes();
    cases_.push_back(std::move(drawn));
    return side;
}

void SkipComparison::add(std::string name, Chain chain) {
    Pair pair;
    pair.name = std::move(name);
    pair.as_is = make_side(chain, pair.name);
    chain.skip = Skip::nothing;
    pair.same = same_work(pair.as_is.runner->plan(), Planner().plan(chain, facts_, options_));
    if (pair.same) {
        pair.no_skip.scene_case = pair.as_is.scene_case;
        pair.no_skip.chain_case = pair.as_is.chain_case;
    } else {
        pair.no_skip = make_side(chain, pair.name);
    }
    pairs_.push_back(std::move(pair));
}

void SkipComparison::measure(int rounds, ProgressBar& progress) {
    host::measure(cases_, rounds, progress);
    const gl::ClockCheck clock = gl::check_clock();
    const bool gpu = clock.timer_queries_honest;
    result_.clock = gpu ? clock.text : "CPU time of all threads; " + clock.text;
    result_.rounds = rounds;
    result_.copy_ms = median(cases_[copy_case].times(gpu));
    result_.scene_ms = median(cases_[bare_scene_case].times(gpu));
    for (const Pair& pair : pairs_)
        result_.rows.push_back(row_of(pair, gpu));
}

SkipComparison::Row SkipComparison::row_of(const Pair& pair, bool gpu) const {
    Row row;
    row.name = pair.name;
    row.same = pair.same;
    row.report = pair.as_is.runner->executor().report();
    row.report.clock = result_.clock;
    row.as_is = frame_of(pair.as_is, *pair.as_is.runner, gpu);
    row.no_skip = pair.same ? row.as_is : frame_of(pair.no_skip, *pair.no_skip.runner, gpu);

    std::vector<double> saved =
        differences(cases_[pair.as_is.chain_case].times(gpu), cases_[pair.no_skip.chain_case].times(gpu));
    if (pair.as_is.scene_case != pair.no_skip.scene_case) {
        saved = sums(saved, differences(cases_[pair.as_is.scene_case].times(gpu),
                                        cases_[pair.no_skip.scene_case].times(gpu)));
    }
    row.saved_ms = median(saved);
    row.saved_p10 = quantile(saved, 0.1);
    row.saved_p90 = quantile(saved, 0.9);
    return row;
}

SkipComparison::Frame SkipComparison::frame_of(const Side& side, const ChainRunner& runner, bool gpu) const {
    const Case &scene = cases_[side.scene_case], &chain = cases_[side.chain_case];
    Frame frame;
    frame.ms = median(sums(scene.times(gpu), chain.times(gpu)));
    frame.chain_ms = median(chain.times(gpu));
    frame.texture_bytes = scene.texture_bytes + chain.texture_bytes;
    frame.attachments = runner.attachments();
    return frame;
}

std::size_t SkipComparison::Row::skipped() const {
    return static_cast<std::size_t>(
        std::count_if(report.effects.begin(), report.effects.end(),
                      [](const PlannedEffect& effect) { return effect.status == EffectStatus::skipped; }));
}

std::int64_t SkipComparison::Row::saved_bytes() const {
    return static_cast<std::int64_t>(no_skip.texture_bytes) - static_cast<std::int64_t>(as_is.texture_bytes);
}

nlohmann::ordered_json skip_json(const SkipComparison::Row& row, double copy_ms) {
    return {{"name", row.name},
            {"same", row.same},
            {"as_is", frame_json(row.as_is, copy_ms)},
            {"no_skip", frame_json(row.no_skip, copy_ms)},
            {"saved",
             {{"ms", row.saved_ms},
              {"p10", row.saved_p10},
              {"p90", row.saved_p90},
              {"copies", row.saved_ms / copy_ms},
              {"texture_bytes", row.saved_bytes()}}}};
}

} // namespace postfx::host
