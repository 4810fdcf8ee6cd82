#include <postfx/attachment.hpp>

#include <algorithm>

namespace postfx {

const AttachmentInfo* find_attachment(std::string_view name) {
    const auto found = std::find_if(known_attachments.begin(), known_attachments.end(),
                                    [&](const AttachmentInfo& info) { return info.name == name; });
    return found == known_attachments.end() ? nullptr : &*found;
}

std::vector<std::string> attachment_names() {
    std::vector<std::string> names;
    for (const AttachmentInfo& info : known_attachments)
        names.emplace_back(info.name);
    return names;
}

} // namespace postfx
