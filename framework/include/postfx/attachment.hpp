// What a host may give to a chain, and what its pixels mean. [any thread]
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace postfx {

struct AttachmentInfo {
    enum class Holds {
        light,  ///< scene-linear
        depth,  ///< samples as the camera's projection makes them
        normal, ///< unit vectors in view space
    };
    std::string_view name;
    Holds holds = Holds::light;
    std::string_view help;
};

/// All that there are; the first is the picture itself, which is always there.
inline constexpr std::array<AttachmentInfo, 5> known_attachments = {{
    {"color", AttachmentInfo::Holds::light, "the picture"},
    {"depth", AttachmentInfo::Holds::depth, "how far each pixel's surface is"},
    {"normal", AttachmentInfo::Holds::normal, "where opaque surfaces face"},
    {"emission", AttachmentInfo::Holds::light, "the light that surfaces send out themselves"},
    {"ambient", AttachmentInfo::Holds::light, "the share of the light in color that occlusion may darken"},
}};

/// Null when there is none of that name.
const AttachmentInfo* find_attachment(std::string_view name);

/// In the order of the table.
std::vector<std::string> attachment_names();

} // namespace postfx
