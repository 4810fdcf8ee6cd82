// A scene as one effect is given it. [GL thread]
#pragma once

#include "run/chain_runner.hpp"
#include "run/scene_view.hpp"
#include "scene/renderer.hpp"

#include <gl/objects.hpp>

#include <memory>
#include <string>

namespace postfx::host::study {

/// A scene with what is asked for again and again.
struct StudyScene {
    explicit StudyScene(Scene opened) : scene(std::move(opened)), bounds(scene) {}
    Scene scene;
    ViewBounds bounds;
};

/// The light that a display is to show of scene-linear light: x / (1 + x), the same for all.
Image64 tone_mapped(Image64 light);

/// The scene's picture of that size with what the effect reads. An effect that belongs behind the tone map is given
/// the tone-mapped picture.
class View {
public:
    /// `samples`: of the scene per pixel, 1 or 4.
    View(StudyScene& scene, const EffectInfo& effect, Size size, int samples);

    const SceneFacts& facts() const { return facts_; }
    const Textures& textures() const { return textures_; }
    FrameInputs frame() const;
    Size size() const { return {facts_.width, facts_.height}; }

    /// The light that the effect is given, 3 channels.
    const Image64& light() const { return *light_; }
    /// The same, or null when it is the scene's own.
    std::shared_ptr<const Image64> given() const { return given_ ? light_ : nullptr; }
    /// Of an attachment, all pixels.
    double bytes_of(const std::string& attachment) const;

    /// As a viewer sees what comes out of the effect: display-linear light.
    Image64 shown(const Image64& light) const { return scene_referred_ ? tone_mapped(light) : light; }

private:
    SceneRenderer renderer_;
    SceneFrame scene_frame_;
    SceneFacts facts_;
    Textures textures_;
    std::shared_ptr<const Image64> light_;
    gl::Texture given_;
    bool scene_referred_;
};

} // namespace postfx::host::study
