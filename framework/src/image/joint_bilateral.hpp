// A map of fewer pixels than its picture, brought to the picture's size along the picture's edges.
#pragma once

#include <postfx/image.hpp>

namespace postfx {

/// `values`: 1 channel, 0 where nothing is, else positive, and affine over the picture where the scene is a plane (1 / z
/// in perspective); `guide`: light, of the size that is wanted, at least that of `values`. Joint bilateral upsampling
/// (Kopf et al. 2007) made robust: of the 4x4 values around a pixel, weighted by distance and by how alike the guide is,
/// the weighted median says which surface is seen, and a plane through that surface's values says where. So no value
/// lies between two surfaces, or between one and nothing. Memory: a few bytes per value beside the result.
Image joint_bilateral(const Image& values, const Image& guide);

/// The nearest of `values` for each of so many pixels: also of fewer than there are values.
Image nearest_values(const Image& values, int width, int height);

} // namespace postfx
