// Which layer and view of image files serve as what.
#pragma once

#include <image/files.hpp>

#include <CLI/CLI.hpp>

#include <map>
#include <string>

namespace postfx::host {

/// The picture, which other roles belong to.
struct ColorInput {
    const ImageSource& source;
    const ImageFile& file;
};

/// --color-layer and the like, --view, --adapt, --only-picture.
class LayerOptions {
public:
    void declare(CLI::App& app);

    ImageRequest color_request() const;
    /// For `source` in another role: in the view of the colour if the file has views, and if it is the colour's own
    /// source, of what was rendered with it.
    ImageRequest request(Role role, const ImageSource& source, const ColorInput& color) const;
    /// Does an EXR go out with all that was in it?
    bool carries() const { return !only_picture_; }

private:
    std::map<Role, std::string> layers_;
    std::string view_, adaptation_ = "none";
    bool only_picture_ = false;
};

} // namespace postfx::host
