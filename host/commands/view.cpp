// postfx view: the chain live in a window.
#include "command.hpp"
#include "options.hpp"
#include "scene_options.hpp"

#include "budget/met_budget.hpp"
#include "budget/running_budget.hpp"
#include "measure/level_trial.hpp"
#include "run/chain_runner.hpp"
#include "run/gl_session.hpp"
#include "run/picture_file.hpp"
#include "run/scene_view.hpp"
#include "window/fly_camera.hpp"
#include "window/window.hpp"

#include <gl/clock.hpp>
#include <gl/objects.hpp>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <filesystem>
#include <optional>

namespace postfx::host {
namespace {

constexpr const char* help = "  W A S D, Q E   fly: forward, left, back, right, down, up (Shift: fast)\n"
                             "  right mouse    look around\n"
                             "  1 - 9          turn the chain's n-th effect on or off\n"
                             "  P              pause the scene\n"
                             "  T              try the levels in the present picture, for the budget\n"
                             "  R              tell what ran and why, and how the budget is kept\n"
                             "  F12            save a picture beside the others (postfx_0000.png ...)\n"
                             "  H              this help\n"
                             "  Esc            leave\n";

/// The first postfx_NNNN.png that is not there yet.
std::filesystem::path next_screenshot() {
    for (int i = 0;; ++i) {
        std::filesystem::path file = fmt::format("postfx_{:04}.png", i);
        if (!std::filesystem::exists(file)) return file;
    }
}

Steering steering_of(const Window& window) {
    const auto axis = [&](int positive, int negative) {
        return static_cast<double>(window.is_down(positive)) - static_cast<double>(window.is_down(negative));
    };
    constexpr double degrees_per_pixel = 0.15;
    Steering steering;
    steering.move = {axis(GLFW_KEY_D, GLFW_KEY_A), axis(GLFW_KEY_E, GLFW_KEY_Q),
                     axis(GLFW_KEY_W, GLFW_KEY_S)};
    steering.turn = glm::dvec2(window.drag().x, -window.drag().y) * degrees_per_pixel;
    steering.fast = window.is_down(GLFW_KEY_LEFT_SHIFT);
    return steering;
}

/// Copies the picture's codes to the window as they are.
class Presenter {
public:
    void show(std::uint32_t texture, glm::ivec2 size) {
        if (texture != shown_ || size != size_) framebuffer_ = gl::make_framebuffer({texture});
        shown_ = texture;
        size_ = size;
        glBlitNamedFramebuffer(framebuffer_.name(), 0, 0, 0, size.x, size.y, 0, 0, size.x, size.y,
                               GL_COLOR_BUFFER_BIT, GL_NEAREST);
    }

private:
    gl::Framebuffer framebuffer_;
    std::uint32_t shown_ = 0;
    glm::ivec2 size_{0};
};

class ViewCommand : public Command {
public:
    void declare(CLI::App& app) override {
        scene_options_.declare(app);
        chain_options_.declare(app);
        catalog_options_.declare(app);
        app.add_option("--frames", frames_, "Leave after so many frames; 0 = stay")->capture_default_str();
        app.add_option("-o,--output", output_,
                       "On leaving, write the last picture here; - is standard output, where text goes to "
                       "stderr then")
            ->type_name("FILE.png");
        app.add_option("--format", format_, "Kind of that picture, whatever FILE is called: png or jpg")
            ->type_name("KIND")
            ->default_str("");
        app.footer(std::string("Keys:\n") + help);
    }

    Status run() override {
        const Catalog catalog = catalog_options_.load();
        Chain chain = chain_options_.read(catalog);
        const Scene scene = scene_options_.open();
        ViewBounds bounds(scene);
        const SceneFacts facts = scene_options_.facts(scene, bounds);
        const PlanOptions options = scene_options_.plan_options(Output::display);
        std::optional<PictureFile> file;
        if (!output_.empty()) file = picture_file(output_, format_);
        if (file && output_for(*file) != Output::display) {
            throw Error(Place{.file = output_}, "the window's picture is for display: name a .png");
        }
        if (file && file->is_standard_output()) text_ = stderr;
        Window window(facts.width, facts.height, "postfx", debug_build);
        SceneRenderer renderer(scene);
        std::optional<MetBudget> met = meet_budget(chain, facts, options, chain_options_.budget_source(),
                                                   trial_inputs(renderer, facts, scene_options_.time()));
        ChainRunner runner(std::move(chain), facts, options);
        if (met) fmt::print(text_, "{}", met->text());
        if (met) budget_.emplace(std::move(*met), runner);
        fmt::print(text_, "{}", help);
        loop(window, runner, renderer, bounds);
        budget_.reset(); // while there is a context
        if (file) write_picture(runner, *file);
        tell_debug_messages();
        return Status::success;
    }

private:
    void loop(Window& window, ChainRunner& runner, SceneRenderer& renderer, ViewBounds& bounds) {
        const Scene& scene = renderer.scene();
        Presenter presenter;
        FlyCamera pilot(scene.camera_at(scene_options_.time()), scene.flying_speed);
        double scene_time = scene_options_.time();
        double last = gl::HostTime::now().wall_ms;
        for (std::uint32_t frame = 0; !window.should_close() && (frames_ == 0 || frame < frames_); ++frame) {
            const double now = gl::HostTime::now().wall_ms;
            const double seconds = (now - last) / 1000;
            last = now;
            if (!paused_) scene_time += seconds;
            pilot.steer(steering_of(window), seconds);

            const glm::ivec2 size = window.size();
            if (size.x > 0 && size.y > 0) {
                // Until the pilot takes over, the scene's own camera drives.
                const Camera camera = pilot.moved() ? pilot.camera() : scene.camera_at(scene_time);
                follow(runner, bounds, camera, size, scene_time);
                FrameInputs inputs;
                inputs.camera = camera;
                inputs.time = scene_time;
                inputs.frame = frame;
                const Textures textures = textures_of(renderer.render(
                    size.x, size.y, scene_time, budget_ ? budget_->attachments(runner) : runner.attachments(),
                    CameraOverride{camera, {}}));
                const std::uint32_t picture = budget_ ? budget_->run(runner, textures, inputs)
                                                      : runner.run(textures, inputs, Timing::off);
                presenter.show(picture, size);
            }
            handle_keys(window, runner, renderer, scene_time);
            window.set_title(fmt::format("postfx  {}  {:.0f} ms{}", scene.name, seconds * 1000,
                                         paused_ ? "  paused" : ""));
            window.swap_and_poll();
        }
    }

    static void follow(ChainRunner& runner, ViewBounds& bounds, const Camera& camera, glm::ivec2 size,
                       double time) {
        SceneFacts facts = runner.facts();
        facts.width = size.x;
        facts.height = size.y;
        look(facts, bounds, camera, time);
        runner.replan(facts);
    }

    void handle_keys(Window& window, ChainRunner& runner, SceneRenderer& renderer, double scene_time) {
        for (int key : window.pressed_keys()) {
            if (key >= GLFW_KEY_1 && key <= GLFW_KEY_9)
                toggle(runner, static_cast<std::size_t>(key - GLFW_KEY_1));
            if (key == GLFW_KEY_P) paused_ = !paused_;
            if (key == GLFW_KEY_H) fmt::print(text_, "{}", help);
            if (key == GLFW_KEY_T && budget_)
                budget_->try_again(runner, trial_inputs(renderer, runner.facts(), scene_time));
            if (key == GLFW_KEY_R)
                fmt::print(text_, "{}{}", report_text(runner.executor().report()),
                           budget_ ? budget_->text(runner) : "");
            if (key == GLFW_KEY_ESCAPE) window.close();
            if (key == GLFW_KEY_F12) {
                const std::filesystem::path file = next_screenshot();
                write_picture(runner, {file});
                fmt::print(text_, "wrote {}\n", file.string());
            }
        }
    }

    void toggle(ChainRunner& runner, std::size_t index) {
        std::vector<ChainEntry>& entries = runner.chain().entries;
        if (index >= entries.size()) return;
        entries[index].enabled = !entries[index].enabled;
        runner.replan(runner.facts());
        if (budget_) budget_->choose_again(runner);
        fmt::print(text_, "{} is {}\n", entries[index].name, entries[index].enabled ? "on" : "off");
    }

    SceneOptions scene_options_{"night_drive"};
    ChainOptions chain_options_{"cinematic"};
    CatalogOptions catalog_options_;
    std::uint32_t frames_ = 0;
    std::string output_, format_;
    std::FILE* text_ = stdout; ///< where text goes
    std::optional<RunningBudget> budget_;
    bool paused_ = false;
};

const Register<ViewCommand> registered("view", "Show a scene through a chain in a window");

} // namespace
} // namespace postfx::host
