// Small models that tests write themselves.
#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace postfx::testing {

/// A glTF file in the making. Starts with asset and one empty scene.
class GltfFile {
public:
    using Json = nlohmann::json;

    Json json = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", Json::array()}}}}};

    template<class T>
    std::size_t view(const std::vector<T>& values) {
        while (bytes_.size() % 4 != 0)
            bytes_.push_back(0);
        const std::size_t offset = bytes_.size(), size = values.size() * sizeof(T);
        bytes_.resize(offset + size);
        std::memcpy(bytes_.data() + offset, values.data(), size);
        return add("bufferViews", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}});
    }
    std::size_t floats(const std::string& type, const std::vector<float>& values) {
        const std::size_t width = type == "SCALAR" ? 1
                                  : type == "MAT4" ? 16
                                                   : static_cast<std::size_t>(type[3] - '0');
        return add("accessors", {{"bufferView", view(values)},
                                 {"componentType", 5126},
                                 {"count", values.size() / width},
                                 {"type", type}});
    }
    std::size_t shorts(const std::string& type, const std::vector<std::uint16_t>& values) {
        const std::size_t width = type == "SCALAR" ? 1 : static_cast<std::size_t>(type[3] - '0');
        return add("accessors", {{"bufferView", view(values)},
                                 {"componentType", 5123},
                                 {"count", values.size() / width},
                                 {"type", type}});
    }
    /// Appends to a list and returns the index.
    std::size_t add(const std::string& list, const Json& item) {
        json[list].push_back(item);
        return json[list].size() - 1;
    }
    /// A node of the scene.
    std::size_t add_node(const Json& node) {
        const std::size_t index = add("nodes", node);
        json["scenes"][0]["nodes"].push_back(index);
        return index;
    }
    /// Corners (-1, -1) to (1, 1) of z = 0, facing +z, with uv 0..1 whose v goes down.
    Json quad_attributes() {
        return {{"POSITION", floats("VEC3", {-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0})},
                {"NORMAL", floats("VEC3", {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1})},
                {"TEXCOORD_0", floats("VEC2", {0, 1, 1, 1, 1, 0, 0, 0})}};
    }
    /// A mesh of one quad; returns its index.
    std::size_t add_quad(const Json& material, Json attributes = {}, const Json& more = Json::object()) {
        if (attributes.empty()) attributes = quad_attributes();
        Json primitive = {{"attributes", attributes},
                          {"indices", shorts("SCALAR", {0, 1, 2, 0, 2, 3})},
                          {"material", add("materials", material)}};
        primitive.update(more);
        return add("meshes", {{"primitives", {primitive}}});
    }
    /// An image file as texture; returns the texture's index.
    std::size_t add_texture(const std::string& uri, const Json& sampler = Json::object()) {
        return add("textures",
                   {{"source", add("images", {{"uri", uri}})}, {"sampler", add("samplers", sampler)}});
    }

    /// Write NAME.gltf, its buffer in NAME.bin or under another name.
    std::filesystem::path write(const std::filesystem::path& file, std::string buffer = "") {
        if (buffer.empty()) buffer = file.stem().string() + ".bin";
        std::ofstream(file.parent_path() / buffer, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes_.data()), static_cast<std::streamsize>(bytes_.size()));
        Json whole = json;
        whole["buffers"] = {
            {{"byteLength", bytes_.size()}, {"uri", buffer_uri.empty() ? buffer : buffer_uri}}};
        std::ofstream(file) << whole.dump();
        return file;
    }
    /// Write NAME.glb, its buffer within.
    std::filesystem::path write_glb(const std::filesystem::path& file) const {
        Json whole = json;
        whole["buffers"] = {{{"byteLength", bytes_.size()}}};
        std::string text = whole.dump();
        text.resize((text.size() + 3) / 4 * 4, ' ');
        std::vector<std::uint8_t> binary = bytes_;
        binary.resize((binary.size() + 3) / 4 * 4);
        std::ofstream out(file, std::ios::binary);
        const auto word = [&](std::uint32_t value) { out.write(reinterpret_cast<const char*>(&value), 4); };
        out << "glTF";
        word(2);
        word(static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary.size()));
        word(static_cast<std::uint32_t>(text.size()));
        out << "JSON" << text;
        word(static_cast<std::uint32_t>(binary.size()));
        out << "BIN" << '\0';
        out.write(reinterpret_cast<const char*>(binary.data()), static_cast<std::streamsize>(binary.size()));
        return file;
    }

    std::string buffer_uri; ///< instead of the buffer file's own name

private:
    std::vector<std::uint8_t> bytes_;
};

/// An 8-bit picture, top row first, four numbers to a pixel.
inline void write_tga(const std::filesystem::path& file, int width, int height,
                      const std::vector<std::uint8_t>& rgba) {
    std::ofstream out(file, std::ios::binary);
    const std::uint8_t head[18] = {0,
                                   0,
                                   2,
                                   0,
                                   0,
                                   0,
                                   0,
                                   0,
                                   0,
                                   0,
                                   0,
                                   0,
                                   static_cast<std::uint8_t>(width),
                                   0,
                                   static_cast<std::uint8_t>(height),
                                   0,
                                   32,
                                   0x28};
    out.write(reinterpret_cast<const char*>(head), sizeof head);
    for (std::size_t i = 0; i < rgba.size(); i += 4) {
        const std::uint8_t bgra[4] = {rgba[i + 2], rgba[i + 1], rgba[i], rgba[i + 3]};
        out.write(reinterpret_cast<const char*>(bgra), 4);
    }
}

} // namespace postfx::testing
