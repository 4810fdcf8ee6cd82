#include "view.hpp"

#include "truths/drawn_scene.hpp"

#include <algorithm>

namespace postfx::host::study {
namespace {

std::vector<std::string> wanted_by(const EffectInfo& effect) {
    std::vector<std::string> wanted = {"color"};
    for (const std::string& name : effect.reads) {
        if (name != "color") wanted.push_back(name);
    }
    return wanted;
}

} // namespace

Image64 tone_mapped(Image64 light) {
    for (double& value : light.values)
        value = value > 0 ? value / (1 + value) : 0;
    return light;
}

View::View(StudyScene& scene, const EffectInfo& effect, Size size, int samples)
    : renderer_(scene.scene, {.samples = samples}),
      scene_frame_(renderer_.render(size.width, size.height, 0, wanted_by(effect))),
      facts_(facts_of(scene.scene, scene.bounds, size, 0)), textures_(textures_of(scene_frame_)),
      scene_referred_(effect.stage == EffectStage::scene) {
    Image64 light = read_light(scene_frame_, "color", size.width, size.height);
    if (effect.stage == EffectStage::display) {
        given_ = gl::Texture(size.width, size.height, Format::rgba16f);
        given_.upload(convert<float>(tone_mapped(std::move(light))));
        textures_["color"] = given_.name();
        light = light_of(gl::read_texture(given_.name(), size.width, size.height, Format::rgba16f));
    }
    light_ = std::make_shared<const Image64>(std::move(light));
}

FrameInputs View::frame() const {
    FrameInputs frame;
    frame.camera = facts_.camera;
    return frame;
}

double View::bytes_of(const std::string& attachment) const {
    for (const SceneAttachment& item : scene_frame_.attachments) {
        if (item.name == attachment)
            return static_cast<double>(format_info(item.format).bytes_per_pixel) * facts_.width
                   * facts_.height;
    }
    return 0;
}

} // namespace postfx::host::study
