#include "drawn_scene.hpp"

#include <gl/objects.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace postfx::host {

Image read_attachment(const SceneFrame& frame, const std::string& name, int width, int height) {
    for (const SceneAttachment& attachment : frame.attachments) {
        if (attachment.name == name)
            return gl::read_texture(attachment.texture, width, height, attachment.format);
    }
    throw Error(fmt::format("the scene was drawn without \"{}\"", name));
}

Image64 light_of(const Image& image) {
    Image64 light(image.width, image.height, 3);
    for (std::size_t i = 0; i < image.pixel_count(); ++i)
        std::copy_n(&image.values[i * image.channels], 3, &light.values[3 * i]);
    return light;
}

Image64 read_light(const SceneFrame& frame, const std::string& name, int width, int height) {
    return light_of(read_attachment(frame, name, width, height));
}

Image64 given_light(const TruthRequest& request, const SceneFrame& frame) {
    return request.given ? *request.given : read_light(frame, "color", request.width, request.height);
}

Image64 given_light(const TruthRequest& request) {
    if (request.given) return *request.given;
    SceneRenderer renderer(request.scene, {.samples = request.scene_samples});
    return given_light(request, renderer.render(request.width, request.height, request.time, {"color"}));
}

} // namespace postfx::host
