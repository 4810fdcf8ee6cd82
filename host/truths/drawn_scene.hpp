// A drawn scene's attachments on the CPU.
#pragma once

#include "truth.hpp"

#include <scene/renderer.hpp>

#include <postfx/image.hpp>

#include <string>

namespace postfx::host {

/// One attachment of a frame of that size, with the channels of its format. Waits for the GPU. Throws Error when the
/// frame has none of that name.
Image read_attachment(const SceneFrame& frame, const std::string& name, int width, int height);

/// The first 3 channels, of 3 or 4.
Image64 light_of(const Image& image);
/// The same of an attachment.
Image64 read_light(const SceneFrame& frame, const std::string& name, int width, int height);

/// The picture that the effect is given: the request's own, else the frame's color.
Image64 given_light(const TruthRequest& request, const SceneFrame& frame);
/// The same where nothing else of the scene is needed: it is drawn only when there is no picture in the request.
Image64 given_light(const TruthRequest& request);

} // namespace postfx::host
