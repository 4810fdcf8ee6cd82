#include "obj_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

namespace postfx::host {
namespace {

constexpr std::string_view blanks = " \t\r\v\f";

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// The next line, which a backslash at its end makes longer, without its end; `text` is what follows.
std::string take_line(std::string_view& text) {
    std::string line;
    for (bool more = true; more && !text.empty();) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view piece = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        while (!piece.empty() && piece.back() == '\r')
            piece.remove_suffix(1);
        more = piece.ends_with('\\');
        if (more) piece.remove_suffix(1);
        line += piece;
        if (more) line += ' ';
    }
    return line;
}

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    for (;;) {
        line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
        if (line.empty()) return words;
        const std::size_t end = std::min(line.find_first_of(blanks), line.size());
        words.push_back(line.substr(0, end));
        line.remove_prefix(end);
    }
}

/// Everything from this word of the line on, without blanks at its end.
std::string_view rest_from(std::string_view line, std::string_view word) {
    const auto begin = static_cast<std::size_t>(word.data() - line.data());
    return line.substr(begin, line.find_last_not_of(blanks) + 1 - begin);
}

/// ".5" and "-.5" with a 0 before the point.
std::string with_digit(std::string_view number) {
    const bool negative = number.starts_with('-');
    const std::string_view plain = number.substr(negative || number.starts_with('+') ? 1 : 0);
    const bool bare = plain.size() > 1 && plain[0] == '.' && is_digit(plain[1]);
    return bare ? fmt::format("{}0{}", negative ? "-" : "", plain) : std::string(number);
}

std::string joined(const std::vector<std::string_view>& words) {
    std::string line(words.front());
    for (auto word = words.begin() + 1; word != words.end(); ++word)
        line += ' ' + with_digit(*word);
    return line;
}

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
    return result;
}

bool is_number(std::string_view word, float& value) {
    const std::string_view plain = word.starts_with('+') ? word.substr(1) : word;
    const auto [end, problem] = std::from_chars(plain.data(), plain.data() + plain.size(), value);
    return problem == std::errc() && end == plain.data() + plain.size();
}

/// What stands before the name of a picture.
struct MapOptions {
    std::string kept; ///< those that assimp knows
    glm::vec2 scale{1}, offset{0};
    std::size_t words = 0;
};

constexpr std::array<std::string_view, 14> map_options = {"-blendu", "-blendv",     "-boost",   "-bm",  "-cc",
                                                          "-clamp",  "-colorspace", "-imfchan", "-mm",  "-o",
                                                          "-s",      "-t",          "-texres",  "-type"};

MapOptions read_map_options(const std::vector<std::string_view>& words) {
    MapOptions options;
    std::size_t i = 1;
    while (i + 1 < words.size()) {
        const std::string name = lower(words[i]);
        if (std::find(map_options.begin(), map_options.end(), name) == map_options.end()) break;
        ++i;
        const bool vector = name == "-o" || name == "-s" || name == "-t";
        const std::size_t most = vector ? 3 : name == "-mm" ? 2 : 1;
        glm::vec2& pair = name == "-s" ? options.scale : options.offset;
        const bool placed = name == "-s" || name == "-o";
        float value = 0;
        // The last word is the picture's name, whatever it looks like.
        for (std::size_t n = 0; n < most && i + 1 < words.size(); ++n, ++i) {
            if (vector && !is_number(words[i], value)) break;
            if (placed && n < 2) pair[static_cast<int>(n)] = value;
        }
        if (name == "-clamp" || name == "-type") options.kept += fmt::format(" {} {}", name, words[i - 1]);
    }
    options.words = i;
    return options;
}

bool names_picture(const std::string& statement) {
    return statement.starts_with("map_") || statement == "bump" || statement == "disp" || statement == "norm"
           || statement == "refl" || statement == "decal";
}

std::string_view without_quotes(std::string_view name) {
    const bool quoted = name.size() > 2 && name.front() == '"' && name.back() == '"';
    return quoted ? name.substr(1, name.size() - 2) : name;
}

std::vector<std::string> libraries_of(std::string_view line, const std::vector<std::string_view>& words,
                                      const std::function<bool(const std::string&)>& is_file) {
    std::string all(without_quotes(rest_from(line, words[1])));
    const std::vector<std::string> each(words.begin() + 1, words.end());
    return is_file(all) || !std::any_of(each.begin(), each.end(), is_file) ? std::vector{std::move(all)}
                                                                           : each;
}

} // namespace

ObjText plain_obj(std::string_view text, const std::function<bool(const std::string&)>& is_file) {
    ObjText result;
    result.text.reserve(text.size() + text.size() / 16);
    while (!text.empty()) {
        const std::string line = take_line(text);
        const auto words = words_of(line);
        if (words.empty()) continue;
        if (words[0] == "mtllib" && words.size() > 1) {
            for (const std::string& name : libraries_of(line, words, is_file)) {
                result.text += fmt::format("mtllib {}\n", name);
                result.libraries.push_back(name);
            }
        } else if (words.size() > 1 && (words[0] == "usemtl" || words[0] == "o" || words[0] == "g")) {
            result.text += fmt::format("{} {}\n", words[0], rest_from(line, words[1]));
        } else {
            result.text += joined(words) + '\n';
        }
    }
    return result;
}

std::string plain_mtl(std::string_view text, MtlPlacements& placements) {
    std::string result, material;
    bool emits = false; // Ke was given
    while (!text.empty()) {
        const std::string line = take_line(text);
        auto words = words_of(line);
        if (words.empty()) continue;
        const std::string statement = lower(words[0]);
        if (statement == "newmtl" && words.size() > 1) {
            material = rest_from(line, words[1]);
            emits = false;
            result += "newmtl " + material;
        } else if (names_picture(statement) && words.size() > 1) {
            const MapOptions options = read_map_options(words);
            if (statement == "map_ke" && !emits) result += "Ke 1 1 1\n";
            result += fmt::format("{}{} {}", words[0], options.kept,
                                  without_quotes(rest_from(line, words[options.words])));
            if (options.scale != glm::vec2(1) || options.offset != glm::vec2(0)) {
                placements[{material, statement}] =
                    glm::mat3x2(options.scale.x, 0, 0, options.scale.y, options.offset.x, options.offset.y);
            }
        } else {
            emits = emits || statement == "ke";
            if (statement == "d" && words.size() > 2 && words[1] == "-halo") words.erase(words.begin() + 1);
            result += joined(words);
        }
        result += '\n';
    }
    return result;
}

} // namespace postfx::host
