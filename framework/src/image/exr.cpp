// OpenEXR: what is asked of a file, found among its layers.
#include <image/exr_attributes.hpp>
#include <image/exr_file.hpp>
#include <image/exr_roles.hpp>

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfPartType.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace postfx::formats {
namespace {

bool recognises_exr(std::string_view bytes) {
    return bytes.starts_with("\x76\x2f\x31\x01");
}

/// Deep data has no single value per pixel; nothing else is refused for its sake.
std::string deep_parts(const ExrFile& exr) {
    std::string text;
    for (int part = 0; part < exr.parts(); ++part)
        if (exr.is_deep(part))
            text += fmt::format("{}{}holds deep data, which has no single value per pixel",
                                text.empty() ? "" : "; ", exr.called(part));
    return text;
}

Coding coding_of(const Imf::Header& header, const ExrLayer& layer) {
    Coding coding{.numbers = Coding::Numbers::half, .bits = 16};
    for (const std::string& name : layer.channels) {
        const Imf::Channel* channel = header.channels().findChannel(name);
        if (channel && channel->type != Imf::HALF) coding = {.numbers = Coding::Numbers::single, .bits = 32};
    }
    // OpenEXR, "Technical Introduction": colour is multiplied by alpha.
    if (layer.has_alpha) coding.alpha = Coding::Alpha::premultiplied;
    return coding;
}

Image first_channels(const Image& image, int channels) {
    Image result(image.width, image.height, channels);
    for (std::size_t pixel = 0; pixel < image.pixel_count(); ++pixel)
        std::copy_n(&image.values[pixel * static_cast<std::size_t>(image.channels)], channels,
                    &result.values[pixel * static_cast<std::size_t>(channels)]);
    return result;
}

/// Depth that was written as a grey picture; three different channels are no depth.
void make_single(const ImageSource& source, const ExrLayer& layer, ImageFile& file) {
    const Image& image = file.image;
    const bool colored = image.channels >= 3;
    for (std::size_t pixel = 0; colored && pixel < image.pixel_count(); ++pixel) {
        const float* values = &image.values[pixel * static_cast<std::size_t>(image.channels)];
        if (std::memcmp(values, values + 1, 2 * sizeof(float)) != 0)
            fail(source.name,
                 fmt::format("its layer \"{}\" has three different channels, so it is no depth; name "
                             "a channel with --depth-layer",
                             layer.label()));
    }
    if (image.channels > 1)
        file.warnings.push_back(fmt::format("depth was taken from the equal channels of \"{}\"{}",
                                            layer.label(), layer.has_alpha ? ", without its alpha" : ""));
    file.image = first_channels(image, 1);
}

/// Measurements have no alpha.
void keep_what_the_role_has(const ImageSource& source, const ExrLayer& layer, Role role, ImageFile& file) {
    if (role == Role::depth && file.image.channels > 1) make_single(source, layer, file);
    if (role == Role::normal && file.image.channels > 3) file.image = first_channels(file.image, 3);
    if (role == Role::depth || role == Role::normal) file.coding.alpha = Coding::Alpha::none;
    if (is_light(role) && layer.shape == ExrLayer::Shape::vector)
        file.warnings.push_back(
            fmt::format("the vectors of \"{}\" were taken for red, green and blue", layer.label()));
}

ImageFile read_exr(const ImageSource& source, const ImageRequest& request) {
    return with_exr_errors(source.name, reading_exr, [&] {
        ExrFile exr(source);
        ImageFile file;
        const ExrLayer layer = layer_for(source, exr, request, file.warnings);
        const Imf::Header& header = exr.header(layer.part);
        file.image = exr.read(layer);
        file.coding = coding_of(header, layer);
        if (exr.contents().layers.size() > 1) file.layer = layer.label();
        file.view = layer.view;
        keep_what_the_role_has(source, layer, request.role, file);
        follow_statements(header, request, file);
        if (request.role == Role::normal)
            if (const std::optional<bool> world = has_world_normals(layer, program_of(header)))
                file.normal_space = *world ? NormalSpace::world : NormalSpace::view;
        return file;
    });
}

PartDescription description_of(const ExrFile& exr, int part) {
    const Imf::Header& header = exr.header(part);
    const ExrWindow window = window_of(header.displayWindow());
    PartDescription description{.width = static_cast<int>(window.width),
                                .height = static_cast<int>(window.height),
                                .attributes = attributes_of(header)};
    if (header.hasName()) description.name = header.name();
    if (header.hasView()) description.view = header.view();
    return description;
}

LayerDescription description_of(const ExrFile& exr, const ExrLayer& layer) {
    LayerDescription description{.name = layer.label(), .view = layer.view, .part = layer.part};
    for (const std::string& name : layer.channels) {
        const Imf::Channel* channel = exr.header(layer.part).channels().findChannel(name);
        if (!channel) continue;
        std::string type = type_name(channel->type);
        if (channel->xSampling != 1 || channel->ySampling != 1)
            type += fmt::format(", every {} x {} pixels", channel->xSampling, channel->ySampling);
        description.channels.push_back({name, type});
    }
    return description;
}

/// What each role would get beside the colour.
std::vector<RoleDescription> roles_of(const ExrContents& contents) {
    std::vector<RoleDescription> roles;
    std::string beside;
    for (const Role role : {Role::color, Role::depth, Role::normal, Role::emission, Role::ambient}) {
        const LayerChoice choice = choose_layer(contents, {.role = role, .beside = beside});
        RoleDescription description{.role = role, .refusal = choice.refusal};
        if (choice.layer) {
            description.layer = choice.layer->label();
            description.view = choice.layer->view;
        }
        if (role == Role::color && contents.layers.size() > 1) beside = description.layer;
        roles.push_back(std::move(description));
    }
    return roles;
}

/// As the colour would have them, on one pixel that stands for all.
void tell_statements(const ExrFile& exr, ImageDescription& description) {
    const std::string deep = deep_parts(exr);
    if (!deep.empty()) description.warnings.push_back(deep);
    const LayerChoice choice = choose_layer(exr.contents(), {});
    if (!choice.layer) return;
    ImageFile file;
    file.image = Image(1, 1, static_cast<int>(choice.layer->channels.size()));
    follow_statements(exr.header(choice.layer->part), {.role = Role::color}, file);
    description.honoured = file.honoured;
    description.warnings.insert(description.warnings.end(), choice.warnings.begin(), choice.warnings.end());
    description.warnings.insert(description.warnings.end(), file.warnings.begin(), file.warnings.end());
}

ImageDescription describe_exr(const ImageSource& source) {
    return with_exr_errors(source.name, reading_exr, [&] {
        const ExrFile exr(source);
        ImageDescription description{.kind = formats::exr.name, .views = exr.contents().views};
        for (int part = 0; part < exr.parts(); ++part)
            description.parts.push_back(description_of(exr, part));
        for (const ExrLayer& layer : exr.contents().layers)
            description.layers.push_back(description_of(exr, layer));
        description.roles = roles_of(exr.contents());
        tell_statements(exr, description);
        return description;
    });
}

} // namespace

ExrLayer layer_for(const ImageSource& source, const ExrFile& exr, const ImageRequest& request,
                   std::vector<std::string>& warnings) {
    const std::string deep = deep_parts(exr);
    if (exr.contents().layers.empty())
        fail(source.name, deep.empty() ? "has no channels" : deep + "; flatten it first");
    const LayerChoice choice =
        choose_layer(exr.contents(), {request.role, request.layer, request.view, request.beside});
    if (!choice.layer) fail(source.name, choice.refusal + (deep.empty() ? "" : "; " + deep));
    if (!deep.empty()) warnings.push_back(deep + ", and was left out");
    warnings.insert(warnings.end(), choice.warnings.begin(), choice.warnings.end());
    return *choice.layer;
}

const Format exr = {"OpenEXR", recognises_exr, read_exr, describe_exr};

} // namespace postfx::formats
