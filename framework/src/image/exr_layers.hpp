// How an EXR file's channel names make layers. Names only, no pixels.
#pragma once

#include <map>
#include <string>
#include <vector>

namespace postfx::formats {

/// Layer name to its channels in order. "" holds the unprefixed R, G, B (and A), or Y (and A) of a file
/// without colour. "left.R", "left.G", "left.B", "left.A", "left.Z" make the layers "left" (4) and "left.Z"
/// (1); "N.X", "N.Y", "N.Z" make "N" (3). A colour always has its R, G and B, present in the file or not.
using Layers = std::map<std::string, std::vector<std::string>>;

Layers group_channels(const std::vector<std::string>& names);

/// The layer that a viewer would show: a file's only channel; else the unprefixed colour; else the first of
/// `views` that has colour; else the first colour in alphabetical order. Null when nothing is a colour.
const Layers::value_type* main_layer(const Layers& layers, const std::vector<std::string>& views);

/// The layer with depth: one channel, named Z or depth, of the fewest prefixes. Null when there is none.
const Layers::value_type* depth_layer(const Layers& layers);

} // namespace postfx::formats
