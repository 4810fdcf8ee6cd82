// What tests of models share.
#pragma once

#include "gltf_files.hpp"

#include <scene/model.hpp>
#include <temporary_directory.hpp>

#include <cstdint>
#include <stdexcept>
#include <vector>

namespace postfx::testing {

inline const std::vector<std::uint8_t> red_green = {255, 0, 0, 255, 0, 255, 0, 255};

inline const host::Mesh& only_mesh(const host::Model& model) {
    for (const host::Node& node : model.nodes) {
        if (!node.parts.empty()) return *node.parts.front().mesh;
    }
    throw std::logic_error("no mesh");
}

} // namespace postfx::testing
