// What a file named as SCENE holds, told by its content.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace postfx::host {

/// How much of a file's beginning is enough to recognize it.
constexpr std::size_t recognized_bytes = std::size_t{1} << 16;

struct FileKind {
    enum class Holds { scene, model, something_else };
    Holds holds = Holds::something_else;
    std::string what; ///< "a glTF model", "a PNG image"; of something else it may be "" (unknown)
    std::string
        ending; ///< of a model whose format is recognized, as files of it are usually named: ".glb"; else ""
};

/// By the file's beginning; `bytes` is the size of the whole file. Its name counts only where the content tells nothing:
/// for models in formats without a mark of their own, and for text that may be a scene full of mistakes.
FileKind recognize(std::string_view start, std::uintmax_t bytes, const std::filesystem::path& name);

/// Only the format of a model by its content, as FileKind::ending; "" when it is none of glTF, GLB, OBJ, PLY, FBX, STL,
/// COLLADA.
std::string model_ending(std::string_view start, std::uintmax_t bytes);

} // namespace postfx::host
