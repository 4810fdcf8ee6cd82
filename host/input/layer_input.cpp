#include "layer_input.hpp"

#include <fmt/format.h>

namespace postfx::host {
void LayerOptions::declare(CLI::App& app) {
    for (const Role role : {Role::color, Role::depth, Role::normal, Role::emission, Role::ambient})
        app.add_option(
               fmt::format("--{}-layer", name_of(role)), layers_[role],
               fmt::format("Layer or channel of an EXR that is the {} (default: by its name)", name_of(role)))
            ->type_name("LAYER");
    app.add_option("--view", view_, "View of a stereo EXR (default: the file's default one)")
        ->type_name("VIEW");
    app.add_option(
           "--adapt", adaptation_,
           "White of another colour space: stays the light that it is (none) or becomes white (bradford)")
        ->check(CLI::IsMember({"none", "bradford"}))
        ->capture_default_str();
    app.add_flag("--only-picture", only_picture_,
                 "EXR to EXR: leave out the input's other layers, views and attributes");
}

ImageRequest LayerOptions::color_request() const {
    return {.role = Role::color,
            .layer = layers_.at(Role::color),
            .view = view_,
            .adaptation = adaptation_ == "none" ? Adaptation::none : Adaptation::bradford};
}

ImageRequest LayerOptions::request(Role role, const ImageSource& source, const ColorInput& color) const {
    ImageRequest request = color_request();
    request.role = role;
    request.layer = layers_.at(role);
    if (&source == &color.source) {
        request.view = color.file.view;
        request.beside = color.file.layer;
    } else if (!request.view.empty() && describe_image(source).views.empty()) {
        request.view.clear();
    }
    return request;
}

} // namespace postfx::host
