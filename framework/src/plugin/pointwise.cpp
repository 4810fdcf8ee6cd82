#include <plugin/pointwise.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace postfx {
namespace {

constexpr std::array forbidden_words = {"uniform",
                                        "buffer",
                                        "shared",
                                        "layout",
                                        "attribute",
                                        "varying",
                                        "discard",
                                        "dFdx",
                                        "dFdy",
                                        "fwidth",
                                        "dFdxFine",
                                        "dFdyFine",
                                        "fwidthFine",
                                        "dFdxCoarse",
                                        "dFdyCoarse",
                                        "fwidthCoarse",
                                        "texture",
                                        "textureProj",
                                        "textureOffset",
                                        "textureProjOffset",
                                        "textureQueryLod",
                                        "interpolateAtCentroid",
                                        "interpolateAtSample",
                                        "interpolateAtOffset",
                                        "barrier",
                                        "memoryBarrier",
                                        "subroutine"};
constexpr std::array forbidden_prefixes = {"gl_",    "image",    "uimage",  "iimage",
                                           "atomic", "isampler", "usampler"};

bool is_word_character(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

bool is_forbidden(std::string_view word) {
    return std::find(forbidden_words.begin(), forbidden_words.end(), word) != forbidden_words.end()
           || std::any_of(forbidden_prefixes.begin(), forbidden_prefixes.end(),
                          [&](std::string_view prefix) { return word.starts_with(prefix); })
           || (word.starts_with("sampler") && word != "sampler2D");
}

/// Walks over GLSL and hands out what is left when comments are gone.
class Reader {
public:
    explicit Reader(std::string_view text) : text_(text) {}

    bool done() {
        skip_comments();
        return at_ >= text_.size();
    }
    char peek() const { return text_[at_]; }
    int line() const { return line_; }
    void advance() {
        if (text_[at_] == '\n') {
            ++line_;
            at_line_start_ = true;
        } else if (!std::isspace(static_cast<unsigned char>(text_[at_]))) {
            at_line_start_ = false;
        }
        ++at_;
    }
    bool at_line_start() const { return at_line_start_; }
    std::string_view word() {
        const std::size_t start = at_;
        while (at_ < text_.size() && is_word_character(text_[at_]))
            advance();
        return text_.substr(start, at_ - start);
    }
    void skip_blanks() {
        while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t'))
            advance();
    }

private:
    void skip_comments() {
        while (at_ + 1 < text_.size() && text_[at_] == '/') {
            const bool line_comment = text_[at_ + 1] == '/';
            if (!line_comment && text_[at_ + 1] != '*') return;
            const bool was_line_start = at_line_start_;
            const std::string_view end = line_comment ? "\n" : "*/";
            const std::size_t found = text_.find(end, at_ + 2);
            const std::size_t stop =
                found == text_.npos ? text_.size() : found + (line_comment ? 0 : end.size());
            while (at_ < stop)
                advance();
            if (!line_comment) at_line_start_ = was_line_start;
        }
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int line_ = 1;
    bool at_line_start_ = true;
};

} // namespace

std::string why_not_pointwise(std::string_view glsl) {
    Reader reader(glsl);
    int depth = 0; // of brackets of any kind; in/out are qualifiers of arguments inside them
    while (!reader.done()) {
        const char c = reader.peek();
        const int line = reader.line();
        if (c == '\\')
            return fmt::format("line {}: has a line continuation, which could hide a directive", line);
        if (c == '#') {
            if (!reader.at_line_start()) return fmt::format("line {}: has a # inside a line", line);
            reader.advance();
            reader.skip_blanks();
            const std::string_view directive = reader.word();
            if (directive != "include" && directive != "define") {
                return fmt::format("line {}: has the directive #{}", line, directive);
            }
        } else if (is_word_character(c)) {
            const std::string_view word = reader.word();
            if (is_forbidden(word)) return fmt::format("line {}: uses {}", line, word);
            if (depth == 0 && (word == "in" || word == "out")) {
                return fmt::format("line {}: declares a shader {}put", line, word);
            }
        } else {
            if (c == '(' || c == '{' || c == '[') ++depth;
            if (c == ')' || c == '}' || c == ']') --depth;
            reader.advance();
        }
    }
    return "";
}

} // namespace postfx
