#include "file_kind.hpp"

#include "model.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace postfx::host {
namespace {

using namespace std::string_view_literals;

constexpr std::string_view blanks = " \t\r\n";

std::string_view without_blanks(std::string_view text) {
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
    return text;
}

bool has_any(std::string_view text, std::initializer_list<std::string_view> words) {
    return std::any_of(words.begin(), words.end(),
                       [&](std::string_view word) { return text.find(word) != std::string_view::npos; });
}

/// JSON with a key that glTF files have and scenes, which may be written as JSON too, do not.
bool is_gltf(std::string_view start) {
    return without_blanks(start).starts_with('{')
           && has_any(start, {"\"asset\""sv, "\"accessors\""sv, "\"bufferViews\""sv, "\"buffers\""sv,
                              "\"meshes\""sv});
}

/// The first line that is no comment, as YAML and OBJ have them, from its first character on.
std::string_view first_line(std::string_view start) {
    std::string_view rest = without_blanks(start);
    while (rest.starts_with('#') || rest.starts_with("---"))
        rest = without_blanks(rest.substr(std::min(rest.find('\n'), rest.size())));
    return rest.substr(0, rest.find('\n'));
}

/// Its first line is a statement; in YAML there would be a colon.
bool is_obj(std::string_view start) {
    const std::string_view line = first_line(start), word = line.substr(0, line.find_first_of(" \t"));
    constexpr std::array statements = {"mtllib"sv, "usemtl"sv, "o"sv,  "g"sv, "s"sv, "v"sv,
                                       "vn"sv,     "vt"sv,     "vp"sv, "f"sv, "l"sv, "p"sv};
    return word.size() < line.size()
           && std::find(statements.begin(), statements.end(), word) != statements.end();
}

/// Does it begin with a key and a colon?
bool is_yaml_map(std::string_view start) {
    std::string_view line = first_line(start);
    line.remove_prefix(std::min(line.find_first_not_of("{\"' \t"), line.size()));
    const std::size_t colon = line.find(':');
    return colon != std::string_view::npos && colon > 0
           && std::all_of(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(colon), [](char c) {
                  return (c >= 'a' && c <= 'z') || c == '_' || c == '"' || c == '\'' || c == ' ';
              });
}

/// Does the name promise a scene, or nothing at all, as that of a pipe?
bool may_name_scene(const std::filesystem::path& name) {
    const std::string ending = name.extension().string();
    return ending.empty() || ending == ".yaml" || ending == ".yml";
}

/// Text, or 80 bytes of anything, a count of triangles and 50 bytes for each.
bool is_stl(std::string_view start, std::uintmax_t bytes) {
    constexpr std::size_t head = 80, triangle = 50;
    std::uint32_t count = 0;
    if (start.size() >= head + sizeof(count)) {
        std::memcpy(&count, start.data() + head, sizeof(count));
        if (bytes == head + sizeof(count) + std::uintmax_t{triangle} * count && count > 0) return true;
    }
    return start.starts_with("solid") && has_any(start, {"facet"sv, "endsolid"sv});
}

/// No image, archive or program: YAML's characters only.
bool is_text(std::string_view start) {
    return std::none_of(start.begin(), start.end(), [](char byte) {
        const auto code = static_cast<unsigned char>(byte);
        return (code < 0x20 && blanks.find(byte) == std::string_view::npos) || code == 0x7F;
    });
}

/// Files that are given in place of a scene; "" when it is none of them.
std::string_view other_content(std::string_view start) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 13> marks = {{
        {"\x89PNG"sv, "a PNG image"sv},
        {"\xFF\xD8\xFF"sv, "a JPEG image"sv},
        {"\x76\x2F\x31\x01"sv, "an EXR image"sv},
        {"#?RADIANCE"sv, "an HDR image"sv},
        {"#?RGBE"sv, "an HDR image"sv},
        {"PF\n"sv, "a PFM image"sv},
        {"Pf\n"sv, "a PFM image"sv},
        {"II*\0"sv, "a TIFF image"sv},
        {"MM\0*"sv, "a TIFF image"sv},
        {"GIF8"sv, "a GIF image"sv},
        {"%PDF"sv, "a PDF"sv},
        {"PK\x03\x04"sv, "an archive"sv},
        {"\x7F"
         "ELF"sv,
         "a program"sv},
    }};
    const auto found = std::find_if(marks.begin(), marks.end(),
                                    [&](const auto& mark) { return start.starts_with(mark.first); });
    return found == marks.end() ? ""sv : found->second;
}

} // namespace

std::string model_ending(std::string_view start, std::uintmax_t bytes) {
    if (start.starts_with("glTF")) return ".glb";
    if (is_gltf(start)) return ".gltf";
    if (start.starts_with("ply\n") || start.starts_with("ply\r")) return ".ply";
    if (start.starts_with("Kaydara FBX Binary") || start.starts_with("; FBX")) return ".fbx";
    if (is_stl(start, bytes)) return ".stl";
    if (without_blanks(start).starts_with('<') && has_any(start, {"<COLLADA"sv})) return ".dae";
    return is_obj(start) ? ".obj" : "";
}

FileKind recognize(std::string_view start, std::uintmax_t bytes, const std::filesystem::path& name) {
    using Holds = FileKind::Holds;
    if (std::string ending = model_ending(start, bytes); !ending.empty())
        return {Holds::model, "a model", ending};
    if (const std::string_view other = other_content(start); !other.empty())
        return {Holds::something_else, std::string(other), ""};
    if (is_model_file(name)) return {Holds::model, "a model", ""};
    if (is_text(start) && (may_name_scene(name) || is_yaml_map(start))) return {Holds::scene, "a scene", ""};
    return {};
}

} // namespace postfx::host
