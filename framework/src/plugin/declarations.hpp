// Reading the C structs of a module: sizes, strides, words and ranges are checked before anything is
// believed.
#pragma once

#include <postfx/catalog.hpp>

#include <cstring>
#include <filesystem>

namespace postfx {

/// A copy of one ABI struct as far as its writer filled it; the rest is zero.
template<class Struct>
Struct copy_abi(const void* from) {
    Struct copy{};
    std::uint32_t size = 0;
    std::memcpy(&size, from, sizeof(size));
    std::memcpy(&copy, from, size < sizeof(Struct) ? size : sizeof(Struct));
    return copy;
}

/// The i-th element of an ABI array with the writer's stride.
template<class Struct>
Struct abi_element(const Struct* first, std::uint32_t stride, std::uint32_t i) {
    return copy_abi<Struct>(reinterpret_cast<const char*>(first) + static_cast<std::size_t>(stride) * i);
}

/// Check and copy one effect of a module. Throws Error naming the module, the effect and the field.
EffectInfo read_effect(const postfx_effect& effect, const std::vector<SourceInfo>& sources,
                       const std::filesystem::path& origin);

/// Check and copy a module's sources, each with its pointwise verdict.
std::vector<SourceInfo> read_sources(const postfx_module& module, const std::filesystem::path& origin);

} // namespace postfx
