#include "occluded_light.hpp"

#include <truths/drawn_scene.hpp>

namespace postfx::host {

OccludedLight::OccludedLight(const TruthRequest& request, const SceneFrame& frame)
    : strength_(request.value("strength")), shows_visibility_(request.value("view") != 0),
      color_(given_light(request, frame)),
      ambient_(read_light(frame, "ambient", request.width, request.height)) {}

Image64 OccludedLight::picture(const Image64& visibility, int count) const {
    Image64 result = shows_visibility_ ? Image64(color_.width, color_.height, 3, 1) : color_;
    for (std::size_t i = 0; i < result.values.size(); ++i) {
        const double occlusion = strength_ * (1 - visibility.values[i / 3] / count);
        result.values[i] -= occlusion * (shows_visibility_ ? 1 : ambient_.values[i]);
    }
    return result;
}

} // namespace postfx::host
