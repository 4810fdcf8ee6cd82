#include "gltf_document.hpp"

#include "asset_files.hpp"
#include "file_kind.hpp"

#include <base/read_file.hpp>

#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace postfx::host {
namespace {

/// What the reader takes into account. Metadata that no picture shows is among it.
constexpr std::array<std::string_view, 11> known_extensions = {
    "KHR_texture_transform",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_lights_punctual",
    "KHR_mesh_quantization",
    "KHR_draco_mesh_compression",
    "EXT_texture_webp",
    "KHR_xmp_json_ld",
};

std::uint32_t word(const std::vector<std::uint8_t>& bytes, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i)
        value |= static_cast<std::uint32_t>(bytes[at + i]) << (8 * i);
    return value;
}

constexpr std::string_view glb_magic = "glTF";
constexpr std::uint32_t json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;

} // namespace

GltfDocument::GltfDocument(const std::filesystem::path& file, const ReadingHooks& hooks, Losses& losses)
    : file_(file), hooks_(hooks) {
    read_container();
    if (version_ == 2) find_version();
    if (version_ == 2) check_extensions(losses);
}

void GltfDocument::fail(const std::string& message) const {
    throw Error({file_.string(), 0, 0, {}, {}}, message);
}

void GltfDocument::read_container() {
    std::error_code problem;
    hooks_.opening(std::filesystem::file_size(file_, problem));
    const std::vector<std::uint8_t> bytes = read_asset(file_);
    std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with(glb_magic)) {
        if (bytes.size() < 20) fail("this .glb ends within its header");
        if (const std::uint32_t version = word(bytes, 4); version == 1) {
            version_ = 1;
            return;
        } else if (version != 2) {
            fail(fmt::format("this .glb is of version {}, expected 2", version));
        }
        text = {};
        for (std::size_t at = 12; at + 8 <= bytes.size();) {
            const std::size_t length = word(bytes, at), type = word(bytes, at + 4);
            at += 8;
            if (length > bytes.size() - at) {
                fail(fmt::format("this .glb says that a chunk has {} bytes, and {} are left", length,
                                 bytes.size() - at));
            }
            if (type == json_chunk && text.empty())
                text = {reinterpret_cast<const char*>(bytes.data()) + at, length};
            if (type == binary_chunk && chunk_.empty()) {
                chunk_.assign(bytes.begin() + static_cast<std::ptrdiff_t>(at),
                              bytes.begin() + static_cast<std::ptrdiff_t>(at + length));
            }
            at += (length + 3) / 4 * 4;
        }
        if (text.empty()) fail("this .glb has no JSON chunk");
    }
    try {
        json_ = Json::parse(text);
    } catch (const Json::exception& error) {
        fail(fmt::format("this is no glTF: {}", error.what()));
    }
}

void GltfDocument::find_version() {
    if (!json_.is_object()) fail("this is no glTF: expected a JSON object");
    const auto asset = json_.find("asset");
    const bool told = asset != json_.end() && asset->is_object() && asset->contains("version")
                      && asset->at("version").is_string();
    const std::string version = told ? asset->at("version").get<std::string>() : "";
    const auto meshes = json_.find("meshes");
    const bool has_objects = meshes != json_.end() && meshes->is_object(); // where version 2 has lists
    if (version.starts_with("1.") || (!told && has_objects)) {
        version_ = 1;
    } else if (!version.starts_with("2.")) {
        fail(fmt::format("this is glTF of version \"{}\", expected 2", version));
    }
}

/// Extensions that materials bring without being listed as used, as careless exporters write.
std::vector<std::string> GltfDocument::unlisted_extensions(const std::vector<std::string>& listed) const {
    std::vector<std::string> result;
    for (std::size_t i = 0; i < count("materials"); ++i) {
        const Json& material = item("materials", i);
        const auto extensions = material.find("extensions");
        if (extensions == material.end() || !extensions->is_object()) continue;
        for (const auto& [name, value] : extensions->items()) {
            if (std::find(listed.begin(), listed.end(), name) == listed.end()
                && std::find(result.begin(), result.end(), name) == result.end())
                result.push_back(name);
        }
    }
    return result;
}

void GltfDocument::check_extensions(Losses& losses) const {
    const auto names = [&](const char* key) {
        std::vector<std::string> result;
        if (json_.contains(key)) result = json_.at(key).get<std::vector<std::string>>();
        return result;
    };
    const auto known = [](const std::string& name) {
        return std::find(known_extensions.begin(), known_extensions.end(), name) != known_extensions.end();
    };
    try {
        for (const std::string& name : names("extensionsRequired")) {
            if (!known(name))
                fail(fmt::format("this model requires the glTF extension {}, which postfx can't read", name));
        }
        static const LossKind kind{"optional extension is left out", "optional extensions are left out"};
        std::vector<std::string> used = names("extensionsUsed");
        for (std::string& name : unlisted_extensions(used))
            used.push_back(std::move(name));
        for (const std::string& name : used) {
            if (!known(name)) losses.add(kind, name);
        }
    } catch (const Json::exception&) {
        fail("extensionsUsed and extensionsRequired are lists of names");
    }
}

std::size_t GltfDocument::count(const char* list) const {
    const auto found = json_.find(list);
    return found != json_.end() && found->is_array() ? found->size() : 0;
}

const GltfDocument::Json& GltfDocument::item(const char* list, std::size_t index) const {
    if (index >= count(list))
        fail(fmt::format("this model refers to {}[{}] and has {}", list, index, count(list)));
    const Json& result = json_.at(list)[index];
    if (!result.is_object()) fail(fmt::format("{}[{}] is no object", list, index));
    return result;
}

std::optional<std::size_t> GltfDocument::find_index(const Json& object, const char* key) const {
    const auto found = object.find(key);
    if (found == object.end()) return std::nullopt;
    if (!found->is_number_unsigned())
        fail(fmt::format("\"{}\" is {}, expected a whole number from 0 up", key, found->dump()));
    return found->get<std::size_t>();
}

std::size_t GltfDocument::index(const Json& object, const char* key) const {
    const auto found = find_index(object, key);
    if (!found) fail(fmt::format("there is no \"{}\" where one has to be", key));
    return *found;
}

float GltfDocument::number(const Json& object, const char* key, float otherwise) const {
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    if (!found->is_number()) fail(fmt::format("\"{}\" is {}, expected a number", key, found->dump()));
    const float value = found->get<float>();
    if (!std::isfinite(value)) fail(fmt::format("\"{}\" is {}, which is too large", key, found->dump()));
    return value;
}

std::optional<std::vector<float>> GltfDocument::numbers(const Json& object, const char* key,
                                                        std::size_t count) const {
    const auto found = object.find(key);
    if (found == object.end()) return std::nullopt;
    std::vector<float> result;
    if (found->is_array()) {
        for (const Json& value : *found) {
            if (value.is_number()) result.push_back(value.get<float>());
        }
    }
    const bool finite =
        std::all_of(result.begin(), result.end(), [](float value) { return std::isfinite(value); });
    if (result.size() != count || found->size() != count || !finite)
        fail(fmt::format("\"{}\" is not a list of {} numbers", key, count));
    return result;
}

const GltfDocument::Json* GltfDocument::extension(const Json& object, const char* name) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object()) return nullptr;
    const auto found = extensions->find(name);
    return found == extensions->end() || !found->is_object() ? nullptr : &*found;
}

const std::vector<std::uint8_t>& GltfDocument::buffer(std::size_t index) const {
    const Json& source = item("buffers", index);
    const auto uri = source.find("uri");
    if (uri == source.end()) {
        if (index != 0 || chunk_.empty()) fail(fmt::format("buffers[{}] has no bytes", index));
        return chunk_;
    }
    const auto [known, added] = buffers_.try_emplace(index);
    if (!added) return known->second;
    if (!uri->is_string()) fail(fmt::format("the uri of buffers[{}] is no text", index));
    const auto name = uri->get<std::string>();
    try {
        if (auto bytes = decode_data_uri(name)) {
            known->second = std::move(*bytes);
            return known->second;
        }
    } catch (const std::invalid_argument& error) {
        fail(fmt::format("buffers[{}]: {}", index, error.what()));
    }
    const auto asset = find_asset(file_, name);
    if (!asset)
        fail(
            fmt::format("there is no file \"{}\", which holds this model's geometry", percent_decoded(name)));
    hooks_.opening(std::filesystem::file_size(*asset));
    known->second = read_asset(*asset);
    return known->second;
}

GltfDocument::Bytes GltfDocument::view_bytes(std::size_t buffer_view) const {
    const Json& view = item("bufferViews", buffer_view);
    const std::vector<std::uint8_t>& bytes = buffer(index(view, "buffer"));
    const std::size_t offset = find_index(view, "byteOffset").value_or(0), length = index(view, "byteLength");
    if (offset > bytes.size() || length > bytes.size() - offset) {
        fail(fmt::format("bufferViews[{}] needs {} bytes from {} on, and its buffer has {}", buffer_view,
                         length, offset, bytes.size()));
    }
    return Bytes(bytes).subspan(offset, length);
}

std::optional<std::vector<std::uint8_t>> GltfDocument::image_bytes(std::size_t index) const {
    const Json& image = item("images", index);
    if (const auto view = find_index(image, "bufferView")) {
        const Bytes bytes = view_bytes(*view);
        return std::vector<std::uint8_t>(bytes.begin(), bytes.end());
    }
    if (!image.contains("uri") || !image.at("uri").is_string())
        fail(fmt::format("images[{}] has no uri", index));
    try {
        return decode_data_uri(image.at("uri").get<std::string>());
    } catch (const std::invalid_argument& error) {
        fail(fmt::format("images[{}]: {}", index, error.what()));
    }
}

bool is_gltf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::array<char, 4> head{};
    stream.read(head.data(), head.size());
    if (std::string_view(head.data(), head.size()) == glb_magic) return true;
    std::error_code unknown;
    return model_ending(read_start(file, recognized_bytes, "a model"),
                        std::filesystem::file_size(file, unknown))
           == ".gltf";
}

} // namespace postfx::host
