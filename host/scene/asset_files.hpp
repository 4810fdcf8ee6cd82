// The files that a model refers to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace postfx::host {

/// "my%20buffer.bin" -> "my buffer.bin" (RFC 3986, 2.1). What is no escape stays.
std::string percent_decoded(const std::string& uri);

/// The regular file beside `model` that it calls `name`: a path or a percent-encoded URI, with slashes of either kind
/// and whatever capitals; of a path that only its author's machine has, the last part. Nothing if there is none.
std::optional<std::filesystem::path> find_asset(const std::filesystem::path& model, const std::string& name);

/// Throws Error naming the file.
std::vector<std::uint8_t> read_asset(const std::filesystem::path& file);

/// The bytes of "data:...;base64,..."; nothing for any other URI. Throws std::invalid_argument for wrong base64.
std::optional<std::vector<std::uint8_t>> decode_data_uri(const std::string& uri);

/// The name of an image format that postfx does not read, from a file's first bytes: "KTX 2", "DDS", ...; empty for
/// others.
std::string unread_picture_kind(const std::uint8_t* bytes, std::size_t size);

} // namespace postfx::host
