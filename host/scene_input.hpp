// SCENE on the command line, with what goes along with it.
#pragma once

#include "level_trial.hpp"
#include "options.hpp"
#include "picture.hpp"

#include "scene/renderer.hpp"
#include "scene/scene.hpp"
#include "scene/view_bounds.hpp"

#include <postfx/plan.hpp>

#include <CLI/CLI.hpp>

#include <string>

namespace postfx::host {

/// What the user means by SCENE, its models read in a process of their own. What they could not bring along is told on
/// stderr, one line for each kind; `strict`: refused instead. Throws Error.
Scene open_known_scene(const std::string& scene, bool strict = false, const std::string& camera = {});

class SceneOptions {
public:
    /// `default_scene` empty: SCENE must be given.
    explicit SceneOptions(std::string default_scene = "") : default_scene_(std::move(default_scene)) {}
    void declare(CLI::App& app);

    Scene open() const;
    double time() const { return time_; }

    /// What is known of a picture of the scene at its time before it is drawn.
    Facts facts(const Scene& scene, ViewBounds& bounds, Output output) const;

private:
    std::string default_scene_, scene_, camera_;
    std::string size_ = "1280x720";
    double time_ = 0;
    bool no_fuse_ = false, strict_ = false;
};

/// What is known of a picture by a scene's own camera before it is drawn.
Facts facts_of(const Scene& scene, ViewBounds& bounds, Size size, double time, Output output);

/// Put another camera into the facts, with what it can see of the scene at that time.
void look(Facts& facts, ViewBounds& bounds, const Camera& camera, double time);

/// What levels are tried on: the facts' picture, drawn by `renderer`, which has to stay.
TrialInputs trial_inputs(SceneRenderer& renderer, const Facts& facts, double time);

/// The frame's textures by attachment name.
Textures textures_of(const SceneFrame& frame);

} // namespace postfx::host
