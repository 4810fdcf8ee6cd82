#include "asset_files.hpp"

#include <base/read_file.hpp>

#include <postfx/error.hpp>

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace postfx::host {
namespace {

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

int base64_digit(char c) {
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    if (c == '+' || c == '-') return 62;
    if (c == '/' || c == '_') return 63;
    return -1;
}

/// Of base64 that may be broken into lines.
std::vector<std::uint8_t> decode_base64(std::string text) {
    std::erase_if(text, [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; });
    while (!text.empty() && text.back() == '=')
        text.pop_back();
    std::vector<std::uint8_t> bytes;
    bytes.reserve(text.size() / 4 * 3 + 2);
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        const int digit = base64_digit(c);
        if (digit < 0) throw std::invalid_argument("wrong base64");
        bits = (bits << 6u) | static_cast<std::uint32_t>(digit);
        count += 6;
        if (count >= 8) {
            count -= 8;
            bytes.push_back(static_cast<std::uint8_t>(bits >> static_cast<unsigned>(count)));
        }
    }
    return bytes;
}

char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

bool same_but_for_case(std::string_view a, std::string_view b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](char x, char y) { return lower(x) == lower(y); });
}

/// The file itself, or the one beside it that is called so but for capitals, as systems that don't tell them apart have it.
std::optional<std::filesystem::path> find_file(const std::filesystem::path& file) {
    std::error_code problem;
    if (std::filesystem::is_regular_file(file, problem)) return file;
    const std::string name = file.filename().string();
    for (const auto& item : std::filesystem::directory_iterator(file.parent_path(), problem)) {
        if (same_but_for_case(item.path().filename().string(), name) && item.is_regular_file(problem))
            return item.path();
    }
    return std::nullopt;
}

/// What a name in a model may mean, the likeliest first: a URI without its query and fragment, or simply a name, with
/// either kind of slash.
std::vector<std::string> readings_of(std::string name) {
    if (name.starts_with("file://")) name.erase(0, 7);
    std::string slashes = name; // files written on Windows
    std::replace(slashes.begin(), slashes.end(), '\\', '/');
    const std::string path = name.substr(0, name.find_first_of("?#"));
    return {percent_decoded(name), name, percent_decoded(slashes), slashes, percent_decoded(path)};
}

} // namespace

std::string percent_decoded(const std::string& uri) {
    std::string result;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool escape =
            uri[i] == '%' && i + 2 < uri.size() && hex_digit(uri[i + 1]) >= 0 && hex_digit(uri[i + 2]) >= 0;
        if (escape) {
            result += static_cast<char>(16 * hex_digit(uri[i + 1]) + hex_digit(uri[i + 2]));
            i += 2;
        } else {
            result += uri[i];
        }
    }
    return result;
}

std::optional<std::filesystem::path> find_asset(const std::filesystem::path& model, const std::string& name) {
    for (const std::string& path : readings_of(name)) {
        const std::size_t last = path.find_last_of('/');
        for (const std::string& candidate :
             {path, last == std::string::npos ? path : path.substr(last + 1)}) {
            if (candidate.empty() || candidate.find('\0') != std::string::npos) continue;
            if (auto file = find_file(folder_of(model) / candidate)) return file;
        }
    }
    return std::nullopt;
}

std::vector<std::uint8_t> read_asset(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary | std::ios::ate);
    const std::streamoff size = stream ? static_cast<std::streamoff>(stream.tellg()) : -1;
    if (size < 0) throw Error({file.string(), 0, 0, {}, {}}, "can't read this file");
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(size));
    stream.seekg(0);
    stream.read(reinterpret_cast<char*>(bytes.data()), size);
    if (!stream) throw Error({file.string(), 0, 0, {}, {}}, "can't read this file");
    return bytes;
}

std::optional<std::vector<std::uint8_t>> decode_data_uri(const std::string& uri) {
    constexpr std::string_view scheme = "data:", base64 = ";base64";
    if (!same_but_for_case(std::string_view(uri).substr(0, scheme.size()), scheme)) return std::nullopt;
    const std::size_t comma = uri.find(',');
    if (comma == std::string::npos) throw std::invalid_argument("a data URI without a comma");
    const std::string text = percent_decoded(uri.substr(comma + 1));
    const std::string_view head = std::string_view(uri).substr(0, comma);
    if (head.size() >= base64.size() && same_but_for_case(head.substr(head.size() - base64.size()), base64))
        return decode_base64(text);
    return std::vector<std::uint8_t>(text.begin(), text.end());
}

std::string unread_picture_kind(const std::uint8_t* bytes, std::size_t size) {
    using namespace std::string_view_literals;
    constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kinds{{
        {"\xabKTX 20\xbb"sv, "KTX 2"},
        {"\xabKTX 11\xbb"sv, "KTX"},
        {"DDS "sv, "DDS"},
        {"sB"sv, "Basis"},
    }};
    const std::string_view head(reinterpret_cast<const char*>(bytes), std::min<std::size_t>(size, 16));
    for (const auto& [magic, name] : kinds) {
        if (head.starts_with(magic)) return std::string(name);
    }
    return {};
}

} // namespace postfx::host
