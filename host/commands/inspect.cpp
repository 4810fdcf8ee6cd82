// postfx inspect: what is in an image file, and what would be taken as what.
#include "command.hpp"

#include "terminal/text_table.hpp"

#include <image/files.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace postfx::host {
namespace {

using Json = nlohmann::ordered_json;
using Rows = std::vector<std::vector<std::string>>;

/// "half R G B A", or "half R G, float Z" where types differ.
std::string channels_text(const std::vector<ChannelDescription>& channels) {
    std::string text, type;
    for (const ChannelDescription& channel : channels) {
        if (channel.type != type) text += fmt::format("{}{}", text.empty() ? "" : ", ", channel.type);
        type = channel.type;
        text += " " + channel.name;
    }
    return text;
}

std::string named(const std::string& name, const std::string& view) {
    return view.empty() ? name : fmt::format("{} (view {})", name, view);
}

std::string part_text(const PartDescription& part, std::size_t index, bool alone) {
    std::string text = alone ? "" : fmt::format("part {}", index + 1);
    if (!part.name.empty() && !alone) text += " " + named(part.name, part.view);
    text += fmt::format("{}{} x {}\n", alone ? "" : ": ", part.width, part.height);
    Rows rows;
    for (const auto& [attribute, value] : part.attributes)
        rows.push_back({attribute, value});
    return text + text_table(rows, 2);
}

std::string layers_text(const ImageDescription& description) {
    const bool several = description.parts.size() > 1;
    Rows rows;
    for (const LayerDescription& layer : description.layers) {
        rows.push_back({named(layer.name, layer.view), channels_text(layer.channels)});
        if (several) rows.back().push_back(fmt::format("part {}", layer.part + 1));
    }
    return "layers\n" + text_table(rows, 2);
}

std::string roles_text(const ImageDescription& description) {
    Rows rows;
    for (const RoleDescription& role : description.roles) {
        const std::string taken = role.layer.empty() ? "the picture" : named(role.layer, role.view);
        rows.push_back({name_of(role.role), role.refusal.empty() ? taken : "- " + role.refusal});
    }
    return "taken as\n" + text_table(rows, 2);
}

std::string lines_text(const char* heading, const std::vector<std::string>& lines) {
    if (lines.empty()) return "";
    return fmt::format("{}\n  {}\n", heading, fmt::join(lines, "\n  "));
}

std::string description_text(const ImageDescription& description) {
    std::string text = description.kind + "\n";
    for (std::size_t part = 0; part < description.parts.size(); ++part)
        text += part_text(description.parts[part], part, description.parts.size() == 1);
    if (!description.views.empty()) text += fmt::format("views\n  {}\n", fmt::join(description.views, ", "));
    return text + layers_text(description) + roles_text(description)
           + lines_text("followed", description.honoured) + lines_text("warnings", description.warnings);
}

Json text_or_null(const std::string& text) {
    return text.empty() ? Json() : Json(text);
}

Json parts_json(const ImageDescription& description) {
    Json parts = Json::array();
    for (const PartDescription& part : description.parts) {
        Json attributes = Json::object();
        for (const auto& [name, value] : part.attributes)
            attributes[name] = value;
        parts.push_back({{"name", text_or_null(part.name)},
                         {"view", text_or_null(part.view)},
                         {"width", part.width},
                         {"height", part.height},
                         {"attributes", attributes}});
    }
    return parts;
}

Json layers_json(const ImageDescription& description) {
    Json layers = Json::array();
    for (const LayerDescription& layer : description.layers) {
        Json channels = Json::array();
        for (const ChannelDescription& channel : layer.channels)
            channels.push_back({{"name", channel.name}, {"type", channel.type}});
        layers.push_back({{"name", text_or_null(layer.name)},
                          {"view", text_or_null(layer.view)},
                          {"part", layer.part + 1},
                          {"channels", channels}});
    }
    return layers;
}

Json roles_json(const ImageDescription& description) {
    Json roles = Json::object();
    for (const RoleDescription& role : description.roles) {
        roles[name_of(role.role)] = {{"taken", role.refusal.empty()},
                                     {"layer", text_or_null(role.layer)},
                                     {"view", text_or_null(role.view)},
                                     {"refusal", text_or_null(role.refusal)}};
    }
    return roles;
}

Json description_json(const std::string& file, const ImageDescription& description) {
    return {{"file", file},
            {"kind", description.kind},
            {"parts", parts_json(description)},
            {"views", description.views},
            {"layers", layers_json(description)},
            {"roles", roles_json(description)},
            {"followed", description.honoured},
            {"warnings", description.warnings}};
}

class InspectCommand : public Command {
public:
    void declare(CLI::App& app) override {
        app.add_option("FILE", file_, "An image of any kind that can be read; - is standard input")
            ->required()
            ->type_name("");
        app.add_flag("--json", json_, "As JSON");
        app.footer("JSON: {file, kind, parts: [{name, view, width, height, attributes}], views, layers: "
                   "[{name, view,\n"
                   "part, channels: [{name, type}]}], roles: {color, depth, normal, emission, ambient: "
                   "{taken, layer,\n"
                   "view, refusal}}, followed, warnings}. Parts count from 1; what there is not is null.");
    }

    Status run() override {
        const ImageDescription description = describe_image(open_image(file_));
        // Names in files need not be UTF-8.
        constexpr auto replace = Json::error_handler_t::replace;
        fmt::print("{}", json_ ? description_json(file_, description).dump(2, ' ', false, replace) + "\n"
                               : description_text(description));
        return Status::success;
    }

private:
    std::string file_;
    bool json_ = false;
};

const Register<InspectCommand> registered("inspect",
                                          "Tell what is in an image file, and what would be taken as what");

} // namespace
} // namespace postfx::host
