// The shipped scenes as inputs for any effect.
#pragma once

#include "hard_inputs.hpp"

#include <gl/objects.hpp>
#include <postfx/error.hpp>
#include <scene/renderer.hpp>
#include <scene/scene.hpp>

#include <string>
#include <vector>

namespace postfx::testing {

/// A scene and its renderer; a GL context must be there (has_gl).
class RenderedScene {
public:
    explicit RenderedScene(const std::string& name)
        : renderer_(host::open_scene(name, directory()), {.samples = 4}) {}

    static std::vector<std::string> names() {
        std::vector<std::string> found;
        for (const host::SceneEntry& entry : host::list_scenes(directory()))
            found.push_back(entry.name);
        return found;
    }

    /// Its start, with every attachment that there is.
    Input input(Size size) {
        const host::SceneFrame frame = renderer_.render(size.width, size.height, 0, attachment_names());
        Input input{.color = {}, .camera = frame.camera, .time = 1.5, .frame = 7};
        for (const host::SceneAttachment& attachment : frame.attachments) {
            Image image = gl::read_texture(attachment.texture, size.width, size.height, attachment.format);
            if (attachment.name == "color") {
                input.color = std::move(image);
            } else {
                input.attachments[attachment.name] = std::move(image);
            }
        }
        return input;
    }

private:
    static std::string directory() { return POSTFX_SOURCE_DIRECTORY "/configs/scenes"; }

    host::SceneRenderer renderer_;
};

} // namespace postfx::testing
