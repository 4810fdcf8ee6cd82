// A glTF 2.0 file as JSON with its buffers; nothing is interpreted yet. What it says of itself is checked: indices,
// lengths and ranges that don't hold throw Error naming the file.
#pragma once

#include "losses.hpp"
#include "model.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace postfx::host {

class GltfDocument {
public:
    using Json = nlohmann::json;
    using Bytes = std::span<const std::uint8_t>;

    /// Reads .gltf and .glb, whatever the name's ending. Refuses required extensions that we don't know by name.
    GltfDocument(const std::filesystem::path& file, const ReadingHooks& hooks, Losses& losses);

    /// Of glTF: 1 or 2. Version 1 is another format, of which nothing is checked.
    int version() const { return version_; }
    const Json& json() const { return json_; }
    std::size_t count(const char* list) const;
    /// json()[list][index].
    const Json& item(const char* list, std::size_t index) const;

    /// The value of `key`, which must be a whole number from 0 up.
    std::size_t index(const Json& object, const char* key) const;
    std::optional<std::size_t> find_index(const Json& object, const char* key) const;
    /// The value of `key` or that default.
    float number(const Json& object, const char* key, float otherwise) const;
    /// So many numbers under `key`, or nothing if there is no such key.
    std::optional<std::vector<float>> numbers(const Json& object, const char* key, std::size_t count) const;
    /// object["extensions"][name], or null.
    static const Json* extension(const Json& object, const char* name);

    Bytes view_bytes(std::size_t buffer_view) const;
    /// The bytes that images[index] has in this file; nothing if they are in a file of their own.
    std::optional<std::vector<std::uint8_t>> image_bytes(std::size_t index) const;

    [[noreturn]] void fail(const std::string& message) const;

private:
    void read_container();
    void find_version();
    void check_extensions(Losses& losses) const;
    std::vector<std::string> unlisted_extensions(const std::vector<std::string>& listed) const;
    const std::vector<std::uint8_t>& buffer(std::size_t index) const;

    std::filesystem::path file_;
    const ReadingHooks& hooks_;
    int version_ = 2;
    Json json_;
    std::vector<std::uint8_t> chunk_; ///< the binary chunk of a .glb
    mutable std::map<std::size_t, std::vector<std::uint8_t>> buffers_;
};

/// By its ending or its first bytes.
bool is_gltf(const std::filesystem::path& file);

/// An accessor's elements as numbers, `width` for each: what is normalised lies in -1..1 or 0..1, sparse values are in
/// place.
std::vector<float> read_numbers(const GltfDocument& document, std::size_t accessor, std::size_t width);
/// How many numbers an element of it has.
std::size_t accessor_width(const GltfDocument& document, std::size_t accessor);
/// An accessor's whole numbers.
std::vector<std::uint32_t> read_integers(const GltfDocument& document, std::size_t accessor,
                                         std::size_t width);

} // namespace postfx::host
