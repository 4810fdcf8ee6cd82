// Normals of images that someone else made.
#pragma once

#include <image/normals.hpp>

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace postfx::host {

/// --normal-space and --world-to-camera.
class NormalOptions {
public:
    void declare(CLI::App& app);

    /// The normals of `file`, which is called `name`, in view space. `color`: of the picture that they belong to, whose camera theirs is. Throws
    /// what view_normals throws, and when the options contradict each other.
    ViewNormals read(const std::string& name, const ImageFile& file, const ImageFile& color,
                     const Camera& camera) const;

private:
    std::string space_;
    std::vector<double> world_to_camera_;
};

} // namespace postfx::host
