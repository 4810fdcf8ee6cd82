// postfx bench: what chains cost, measured alternately in one run and told in copy passes.
#include "command.hpp"
#include "gl_session.hpp"
#include "options.hpp"
#include "picture.hpp"
#include "scene_input.hpp"

#include <gl/clock.hpp>
#include <gl/objects.hpp>
#include <image/metrics.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <random>

namespace postfx::host {
namespace {

constexpr int warm_up_rounds = 3;

/// Something to measure, with its samples.
struct Case {
    std::string name;
    std::function<void()> draw;
    std::vector<double> cpu_ms, wall_ms, gpu_ms;
};

double quantile(std::vector<double> samples, double share) {
    if (samples.empty()) return 0;
    const auto at =
        samples.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(samples.size() - 1));
    std::nth_element(samples.begin(), at, samples.end());
    return *at;
}

nlohmann::ordered_json spread(const std::vector<double>& samples) {
    return {
        {"median", quantile(samples, 0.5)}, {"p10", quantile(samples, 0.1)}, {"p90", quantile(samples, 0.9)}};
}

/// A full-screen pass with a fragment shader of its own: the unit of account, and hand-written rivals.
/// The shader samples `u_color` at binding 0 (nearest) or `u_color_linear` at binding 1.
class PlainPass {
public:
    PlainPass(int width, int height, Format format, const std::string& fragment, const std::string& name)
        : target_(width, height, format), framebuffer_(gl::make_framebuffer({target_.name()})),
          program_(
              gl::make_program("#version 450 core\nvoid main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : "
                               "-1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }",
                               fragment, name, {name})),
          vertex_array_(gl::make_vertex_array()), nearest_(gl::make_sampler(false)),
          linear_(gl::make_sampler(true)) {}

    void draw(GLuint color) const {
        glDisable(GL_DEPTH_TEST);
        glDisable(GL_BLEND);
        glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
        glViewport(0, 0, target_.width(), target_.height());
        glUseProgram(program_.name());
        glBindVertexArray(vertex_array_.name());
        glBindTextureUnit(0, color);
        glBindSampler(0, nearest_.name());
        glBindTextureUnit(1, color);
        glBindSampler(1, linear_.name());
        glDrawArrays(GL_TRIANGLES, 0, 3);
        glBindSampler(0, 0);
        glBindSampler(1, 0);
    }
    Image picture() const {
        return gl::read_texture(target_.name(), target_.width(), target_.height(), target_.format());
    }

private:
    gl::Texture target_;
    gl::Framebuffer framebuffer_;
    gl::Program program_;
    gl::VertexArray vertex_array_;
    gl::Sampler nearest_, linear_;
};

constexpr const char* copy_shader =
    "#version 450 core\n"
    "layout(binding = 0) uniform sampler2D u_color;\n"
    "layout(location = 0) out vec4 o_color;\n"
    "void main() { o_color = texelFetch(u_color, ivec2(gl_FragCoord.xy), 0); }\n";

std::string read_text(const std::string& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw Error(Place{.file = file}, "can't be read");
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

class BenchCommand : public Command {
public:
    void declare(CLI::App& app) override {
        scene_options_.declare(app);
        app.add_option("--chain", chains_,
                       "Chain to measure, by name or file (repeatable; default cinematic)")
            ->type_name("CHAIN")
            ->default_str("")
            ->allow_extra_args(false);
        app.add_option(
               "--against", rivals_,
               "A whole fragment shader to measure beside them; it reads u_color (binding 0, or 1 for linear "
               "filtering) and writes location 0 (repeatable)")
            ->type_name("GLSL")
            ->default_str("")
            ->allow_extra_args(false);
        app.add_flag("--unfused", unfused_, "Measure every chain without fusion as well");
        app.add_flag("--live", live_,
                     "Measure every chain with its values in uniforms as well, as while they are moved");
        app.add_flag("--watch-nonfinite", watch_, "Measure every chain while it is watched for NaN as well");
        app.add_flag("--passes", passes_, "Tell every pass of the chains as well");
        app.add_flag("--with-scene", with_scene_, "Draw the scene in every sample, as a frame would");
        app.add_option("--samples", samples_, "Rounds; each measures everything once, in random order")
            ->check(CLI::Range(3, 100000))
            ->capture_default_str();
        app.add_option("--format", format_, "Of working targets and the copy pass")
            ->check(CLI::IsMember({"rgba16f", "rgba32f"}))
            ->capture_default_str();
        app.add_flag("--linear", linear_, "Measure without output encoding");
        app.add_flag("--json", json_, "As JSON");
        catalog_options_.declare(app);
    }

    Status run() override {
        const Catalog catalog = catalog_options_.load();
        const Scene scene = scene_options_.open();
        facts_ =
            scene_options_.facts(scene, scene_options_.time(), linear_ ? Output::linear : Output::display);
        facts_.working_format = *format_by_name(format_);
        facts_.fold = true;
        const GlSession session;
        SceneRenderer renderer(scene);
        make_runners(catalog);
        const std::vector<std::string> wanted = wanted_attachments();
        const auto draw_scene = [&] {
            return textures_of(renderer.render(facts_.width, facts_.height, scene_options_.time(), wanted));
        };
        const Textures textures = draw_scene();

        std::vector<Case> cases = make_cases(textures, draw_scene);
        measure(cases);
        tell(cases, gl::check_clock(), session.device());
        return Status::success;
    }

private:
    struct NamedRunner {
        std::string name;
        std::unique_ptr<ChainRunner> runner;
    };

    void make_runners(const Catalog& catalog) {
        if (chains_.empty()) chains_.emplace_back("cinematic");
        for (const std::string& name : chains_) {
            const Chain chain = read_chain_named(name, catalog);
            runners_.push_back({name, std::make_unique<ChainRunner>(chain, facts_)});
            Facts other = facts_;
            other.fuse = false;
            if (unfused_)
                runners_.push_back({name + " (unfused)", std::make_unique<ChainRunner>(chain, other)});
            other = facts_;
            other.fold = false;
            if (live_) runners_.push_back({name + " (live)", std::make_unique<ChainRunner>(chain, other)});
        }
    }

    std::vector<std::string> wanted_attachments() const {
        std::vector<std::string> wanted = {"color"};
        for (const NamedRunner& named : runners_) {
            for (const std::string& name : named.runner->attachments()) {
                if (std::find(wanted.begin(), wanted.end(), name) == wanted.end()) wanted.push_back(name);
            }
        }
        return wanted;
    }

    template<class DrawScene>
    std::vector<Case> make_cases(const Textures& textures, const DrawScene& draw_scene) {
        const auto framed = [this, draw_scene](std::function<void()> draw) -> std::function<void()> {
            if (!with_scene_) return draw;
            return [draw_scene, draw] {
                draw_scene();
                draw();
            };
        };
        const GLuint color = textures.at("color");
        std::vector<Case> cases;
        const auto plain = [&](Format format, const std::string& text, const std::string& name) {
            const auto pass = std::make_shared<PlainPass>(facts_.width, facts_.height, format, text, name);
            return std::function<void()>([pass, color] { pass->draw(color); });
        };
        cases.push_back({"copy pass", plain(facts_.working_format, copy_shader, "copy pass"), {}, {}, {}});
        if (with_scene_) cases.push_back({"scene alone", framed([] {}), {}, {}, {}});
        for (const std::string& rival : rivals_) {
            const Format format = linear_ ? facts_.working_format : Format::rgba8;
            const auto pass =
                std::make_shared<PlainPass>(facts_.width, facts_.height, format, read_text(rival), rival);
            cases.push_back({rival, framed([pass, color] { pass->draw(color); }), {}, {}, {}});
            compare_with_rival(*pass, rival, textures);
        }
        FrameInputs frame;
        frame.camera = facts_.camera;
        frame.time = scene_options_.time();
        for (const NamedRunner& named : runners_) {
            ChainRunner* runner = named.runner.get();
            const auto add = [&](const std::string& name, Watch watch) {
                cases.push_back({name,
                                 framed([runner, textures, frame, watch] {
                                     runner->run(textures, frame, Timing::off, watch);
                                 }),
                                 {},
                                 {},
                                 {}});
            };
            add(named.name, Watch::off);
            if (watch_) add(named.name + " (watched)", Watch::nonfinite);
        }
        if (passes_) frame_ = frame;
        textures_ = textures;
        return cases;
    }

    /// A rival that draws another picture measures nothing: tell how far it is from the first chain's.
    void compare_with_rival(const PlainPass& pass, const std::string& name, const Textures& textures) {
        FrameInputs frame;
        frame.camera = facts_.camera;
        frame.time = scene_options_.time();
        pass.draw(textures.at("color"));
        runners_.front().runner->run(textures, frame, Timing::off);
        const Difference difference =
            compare(pass.picture(), runners_.front().runner->executor().read_picture());
        const std::size_t pixels = static_cast<std::size_t>(facts_.width) * facts_.height;
        rival_notes_.push_back(
            fmt::format("{} and {} differ by at most {:.4f} in {:.3f} % of the pixels", name,
                        runners_.front().name, difference.max_abs,
                        100.0 * static_cast<double>(difference.differing) / static_cast<double>(pixels)));
    }

    void measure(std::vector<Case>& cases) {
        std::mt19937 random(1);
        std::vector<std::size_t> order(cases.size());
        for (std::size_t i = 0; i < order.size(); ++i)
            order[i] = i;
        gl::Query query = make_query();
        ProgressBar progress("measuring", samples_ + warm_up_rounds);
        for (int round = -warm_up_rounds; round < samples_; ++round) {
            std::shuffle(order.begin(), order.end(), random);
            for (std::size_t i : order) {
                glFinish();
                const gl::HostTime start = gl::HostTime::now();
                glBeginQuery(GL_TIME_ELAPSED, query.name());
                cases[i].draw();
                glEndQuery(GL_TIME_ELAPSED);
                glFinish();
                const gl::HostTime end = gl::HostTime::now();
                if (round < 0) continue;
                GLuint64 elapsed_ns = 0;
                glGetQueryObjectui64v(query.name(), GL_QUERY_RESULT, &elapsed_ns);
                cases[i].cpu_ms.push_back(end.cpu_ms - start.cpu_ms);
                cases[i].wall_ms.push_back(end.wall_ms - start.wall_ms);
                cases[i].gpu_ms.push_back(static_cast<double>(elapsed_ns) * 1e-6);
            }
            if (passes_ && round >= 0) measure_passes();
            progress.advance();
        }
        for (Case& row : pass_rows_)
            cases.push_back(std::move(row));
    }

    static gl::Query make_query() {
        GLuint name = 0;
        glCreateQueries(GL_TIME_ELAPSED, 1, &name);
        return gl::Query(name);
    }

    void measure_passes() {
        std::size_t row = 0;
        for (const NamedRunner& named : runners_) {
            named.runner->run(textures_, frame_, Timing::profile);
            for (const PassReport& pass : named.runner->executor().report().passes) {
                if (row == pass_rows_.size()) {
                    pass_rows_.push_back({fmt::format("{}: {}", named.name, pass.name), {}, {}, {}, {}});
                }
                pass_rows_[row].cpu_ms.push_back(*pass.cpu_ms);
                pass_rows_[row].wall_ms.push_back(*pass.wall_ms);
                ++row;
            }
        }
    }

    void tell(const std::vector<Case>& cases, const gl::ClockCheck& clock,
              const gl::DeviceInfo& device) const {
        const bool gpu = clock.timer_queries_honest;
        const auto unit_of = [&](const Case& row) { return quantile(gpu ? row.gpu_ms : row.cpu_ms, 0.5); };
        const double copy = unit_of(cases.front());
        const std::string clock_text = gpu ? clock.text : "CPU time of all threads; " + clock.text;
        if (json_) {
            nlohmann::ordered_json json = {
                {"device", device.renderer}, {"clock", clock_text},
                {"width", facts_.width},     {"height", facts_.height},
                {"format", format_},         {"samples", samples_},
                {"rivals", rival_notes_},    {"rows", nlohmann::ordered_json::array()}};
            for (const Case& row : cases) {
                nlohmann::ordered_json item = {
                    {"name", row.name}, {"cpu_ms", spread(row.cpu_ms)}, {"wall_ms", spread(row.wall_ms)}};
                if (gpu && !row.gpu_ms.empty()) item["gpu_ms"] = spread(row.gpu_ms);
                item["copies"] = unit_of(row) / copy;
                json["rows"].push_back(std::move(item));
            }
            fmt::print("{}\n", json.dump(2));
            return;
        }
        std::size_t width = 4;
        for (const Case& row : cases)
            width = std::max(width, row.name.size());
        fmt::print("{}x{} {}, {} rounds on {}\nclock: {}\n\n{:<{}}  {:>9}  {:>19}  {:>9}  {:>7}\n",
                   facts_.width, facts_.height, format_, samples_, device.renderer, clock_text, "", width,
                   gpu ? "gpu ms" : "cpu ms", "p10 - p90", "wall ms", "copies");
        for (const Case& row : cases) {
            const std::vector<double>& times = gpu && !row.gpu_ms.empty() ? row.gpu_ms : row.cpu_ms;
            fmt::print("{:<{}}  {:9.2f}  {:>8.2f} - {:<8.2f}  {:9.2f}  {:7.2f}\n", row.name, width,
                       quantile(times, 0.5), quantile(times, 0.1), quantile(times, 0.9),
                       quantile(row.wall_ms, 0.5), unit_of(row) / copy);
        }
        for (const std::string& note : rival_notes_)
            fmt::print("{}\n", note);
    }

    SceneOptions scene_options_{"night_drive"};
    CatalogOptions catalog_options_;
    std::vector<std::string> chains_, rivals_;
    std::string format_ = "rgba16f";
    int samples_ = 21;
    bool unfused_ = false, live_ = false, watch_ = false, passes_ = false, with_scene_ = false,
         linear_ = false, json_ = false;

    Facts facts_;
    FrameInputs frame_;
    Textures textures_;
    std::vector<NamedRunner> runners_;
    std::vector<Case> pass_rows_;
    std::vector<std::string> rival_notes_;
};

const Register<BenchCommand> registered("bench", "Measure what chains cost, in copy passes");

} // namespace
} // namespace postfx::host
