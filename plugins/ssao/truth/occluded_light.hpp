// What is shown of ambient occlusion once its visibility is known.
#pragma once

#include <scene/renderer.hpp>
#include <truths/truth.hpp>

namespace postfx::host {

/// The picture with its ambient share darkened, or the visibility alone, as the effect's values say.
class OccludedLight {
public:
    /// `frame` has "color" and "ambient", of the request's size.
    OccludedLight(const TruthRequest& request, const SceneFrame& frame);

    /// 3 channels; `visibility` is a sum of `count` samples of one channel, each 0 to 1.
    Image64 picture(const Image64& visibility, int count) const;

private:
    double strength_;
    bool shows_visibility_;
    Image64 color_, ambient_;
};

} // namespace postfx::host
