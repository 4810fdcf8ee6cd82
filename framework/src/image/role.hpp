// What an image is asked for.
#pragma once

namespace postfx {

/// Light (color, emission, ambient) is decoded as the file says: profiles, gamma, primaries. Measurements (depth,
/// normal, data) are numbers: colour profiles and gamma are ignored, codes are divided by the largest code, but the
/// orientation of a photograph turns the maps that belong to it. A texture is a model's: its codes as they are
/// stored, nothing is applied: glTF 2.0 demands it of ICC profiles and permits it of EXIF, so an orientation is not either.
enum class Role { color, emission, ambient, depth, normal, data, texture };

constexpr bool is_light(Role role) {
    return role == Role::color || role == Role::emission || role == Role::ambient;
}

/// "color", "depth", ...: as the options of the program are called.
constexpr const char* name_of(Role role) {
    switch (role) {
    case Role::color:
        return "color";
    case Role::emission:
        return "emission";
    case Role::ambient:
        return "ambient";
    case Role::depth:
        return "depth";
    case Role::normal:
        return "normal";
    case Role::data:
        return "data";
    case Role::texture:
        return "texture";
    }
    return "";
}

} // namespace postfx
