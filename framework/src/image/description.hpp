// What is in an image file, as told by `postfx inspect`: plain words, no pixels.
#pragma once

#include <image/role.hpp>

#include <string>
#include <utility>
#include <vector>

namespace postfx {

struct ChannelDescription {
    std::string name{}; ///< as the file has it
    std::string type{}; ///< "half", "float", "uint", "8 bit", "16 bit"
};

/// Channels that belong together: what a role can take.
struct LayerDescription {
    std::string name{}, view{};
    int part = 0;
    std::vector<ChannelDescription> channels{};
};

/// One picture of a file; files other than EXR and HEIC have one.
struct PartDescription {
    std::string name{}, view{};
    int width = 0, height = 0;
    std::vector<std::pair<std::string, std::string>>
        attributes{}; ///< windows, compression, profile, ...: name and value
};

/// What a role would get: a layer's name, or why it gets none.
struct RoleDescription {
    Role role = Role::color;
    std::string layer{}, view{};
    std::string refusal{}; ///< "" when a layer is taken
};

struct ImageDescription {
    std::string kind{}; ///< "OpenEXR", "PNG", ...
    std::vector<std::string> views{};
    std::vector<PartDescription> parts{};
    std::vector<LayerDescription> layers{};
    std::vector<RoleDescription> roles{};
    std::vector<std::string> honoured{}, warnings{}; ///< as ImageFile has them for the colour
};

} // namespace postfx
