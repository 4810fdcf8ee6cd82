// SCENE on the command line, with what goes along with it.
#pragma once

#include "run/scene_view.hpp"

#include "scene/scene.hpp"

#include <postfx/plan.hpp>

#include <CLI/CLI.hpp>

#include <string>

namespace postfx::host {

/// SCENE, --size, --time, --camera, --strict and --no-fuse.
class SceneOptions {
public:
    /// `default_scene` empty: SCENE must be given.
    explicit SceneOptions(std::string default_scene = "") : default_scene_(std::move(default_scene)) {}
    void declare(CLI::App& app);

    Scene open() const;
    double time() const { return time_; }

    /// What is known of a picture of the scene at its time before it is drawn.
    SceneFacts facts(const Scene& scene, ViewBounds& bounds) const;
    /// What is wished of its plan.
    PlanOptions plan_options(Output output) const { return {.output = output, .fuse = !no_fuse_}; }

private:
    std::string default_scene_, scene_, camera_;
    std::string size_ = "1280x720";
    double time_ = 0;
    bool no_fuse_ = false, strict_ = false;
};

} // namespace postfx::host
