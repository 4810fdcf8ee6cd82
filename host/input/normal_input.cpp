#include "normal_input.hpp"

#include "terminal/number_checks.hpp"

#include <postfx/error.hpp>

#include <algorithm>

namespace postfx::host {

void NormalOptions::declare(CLI::App& app) {
    app.add_option("--normal-space", space_,
                   "view or world: what the axes of normals are (default: what the file says, else view)")
        ->check(CLI::IsMember({"view", "world"}));
    app.add_option(
           "--world-to-camera", world_to_camera_,
           "The camera of normals of world space (default: worldToCamera of the EXR): 16 numbers, column "
           "by column; the camera looks along -z")
        ->expected(16)
        ->check(finite())
        ->default_str("");
}

ViewNormals NormalOptions::read(const std::string& name, const ImageFile& file, const ImageFile& color,
                                const Camera& camera) const {
    NormalSource source{.name = name, .coding = file.coding};
    if (!space_.empty())
        source.space = space_ == "world" ? NormalSpace::world : NormalSpace::view;
    else if (file.normal_space)
        source.space = *file.normal_space;
    if (!world_to_camera_.empty()) {
        if (source.space == NormalSpace::view)
            throw Error("--world-to-camera is for normals of world space; say --normal-space world");
        source.world_to_camera.emplace();
        std::copy(world_to_camera_.begin(), world_to_camera_.end(), source.world_to_camera->begin());
    } else {
        source.world_to_camera =
            file.shot.world_to_camera ? file.shot.world_to_camera : color.shot.world_to_camera;
    }
    return view_normals(file.image, source, camera);
}

} // namespace postfx::host
