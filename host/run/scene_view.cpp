#include "scene_view.hpp"

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <charconv>

namespace postfx::host {

Size parse_size(const std::string& text) {
    constexpr int largest_side = 32768; // as of image files; a device that has less says so itself
    Size size;
    const std::size_t x = text.find('x');
    const auto read = [&](std::size_t from, std::size_t to, int& number) {
        const auto result = std::from_chars(text.data() + from, text.data() + to, number);
        return result.ec == std::errc() && result.ptr == text.data() + to && number >= 1
               && number <= largest_side;
    };
    if (x == std::string::npos || !read(0, x, size.width) || !read(x + 1, text.size(), size.height)) {
        throw Error(fmt::format("size \"{}\" is not WIDTHxHEIGHT with sides of 1 to {}, such as 1280x720",
                                text, largest_side));
    }
    return size;
}

SceneFacts facts_of(const Scene& scene, ViewBounds& bounds, Size size, double time) {
    SceneFacts facts;
    facts.width = size.width;
    facts.height = size.height;
    facts.attachments = attachment_names();
    look(facts, bounds, scene.camera_at(time), time);
    return facts;
}

void look(SceneFacts& facts, ViewBounds& bounds, const Camera& camera, double time) {
    facts.camera = camera;
    facts.bounds = bounds.at(time, camera, facts.width, facts.height);
}

Textures textures_of(const SceneFrame& frame) {
    Textures textures;
    for (const SceneAttachment& attachment : frame.attachments)
        textures[attachment.name] = attachment.texture;
    return textures;
}

} // namespace postfx::host
