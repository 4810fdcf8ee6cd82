#include <plugin/pointwise.hpp>
#include <plugin/uncomment.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

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

bool is_forbidden(std::string_view word) {
    return std::find(forbidden_words.begin(), forbidden_words.end(), word) != forbidden_words.end()
           || std::any_of(forbidden_prefixes.begin(), forbidden_prefixes.end(),
                          [&](std::string_view prefix) { return word.starts_with(prefix); })
           || (word.starts_with("sampler") && word != "sampler2D");
}

/// Reads GLSL without comments, word by word.
class Scan {
public:
    explicit Scan(std::string_view code) : code_(code) {}

    std::optional<std::string> run() {
        while (at_ < code_.size() && !why_) {
            const char c = code_[at_];
            if (c == '#') {
                begin_directive();
            } else if (is_word_character(c)) {
                read_word();
            } else {
                if (c == '\n') {
                    end_line();
                } else if (!is_blank(c)) {
                    read_mark(c);
                }
                ++at_;
            }
        }
        if (!why_) end_line();
        return why_;
    }

private:
    template<class... Args>
    void refuse(fmt::format_string<Args...> format, Args&&... args) {
        why_ = fmt::format("line {}: {}", line_, fmt::format(format, std::forward<Args>(args)...));
    }

    std::string_view take_word() {
        while (at_ < code_.size() && is_blank(code_[at_]))
            ++at_;
        const std::size_t start = at_;
        while (at_ < code_.size() && is_word_character(code_[at_]))
            ++at_;
        return code_.substr(start, at_ - start);
    }

    void begin_directive() {
        if (!at_line_start_) return refuse("has a # inside a line");
        ++at_;
        at_line_start_ = false;
        in_directive_ = true;
        const std::string_view directive = take_word();
        if (directive != "include" && directive != "define") {
            return refuse("has the directive #{}", directive);
        }
        if (directive == "include") return;
        // A macro of another name could stand in the code that is generated behind this.
        const std::string_view name = take_word();
        const auto capital = [](char c) {
            return (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
        };
        if (!std::all_of(name.begin(), name.end(), capital)) {
            refuse("defines the macro {}, whose name is not in capitals", name);
        }
    }

    void read_word() {
        at_line_start_ = false;
        const std::string_view word = take_word();
        if (is_forbidden(word)) return refuse("uses {}", word);
        if (in_directive_ || depth_ > 0) return;
        if (word == "in" || word == "out") return refuse("declares a shader {}put", word);
        if (first_.empty()) first_ = word;
        last_ = word;
    }

    void read_mark(char c) {
        at_line_start_ = false;
        if (c == '(' && depth_ == 0 && !in_directive_) called_ = true;
        const bool ends_name = c == '=' || c == ';' || c == ',';
        if (!in_directive_ && depth_ == 0 && ends_name) {
            // A variable that outlives a call would join what should not know of each other.
            if (!first_.empty() && !called_ && first_ != "const" && first_ != "struct"
                && first_ != "precision") {
                return refuse("declares the variable {} outside functions", last_);
            }
        }
        int& depth = in_directive_ ? directive_depth_ : depth_;
        if (c == '(' || c == '{' || c == '[') ++depth;
        if (c == ')' || c == '}' || c == ']') --depth;
        if (depth < 0) return refuse("closes a bracket that is not open");
        if (!in_directive_ && depth_ == 0 && (c == ';' || c == '}')) end_statement();
    }

    void end_line() {
        if (directive_depth_ != 0) return refuse("defines a macro that leaves a bracket open");
        ++line_;
        at_line_start_ = true;
        in_directive_ = false;
    }

    void end_statement() {
        first_ = last_ = {};
        called_ = false;
    }

    std::string_view code_;
    std::size_t at_ = 0;
    std::optional<std::string> why_;
    int line_ = 1;
    bool at_line_start_ = true, in_directive_ = false;
    int depth_ = 0, directive_depth_ = 0; ///< of brackets of any kind
    std::string_view first_, last_;       ///< words of the statement outside functions
    bool called_ = false;                 ///< it has an argument list, so it is a function
};

} // namespace

std::string why_not_pointwise(std::string_view glsl) {
    const Uncommented uncommented = uncomment(glsl);
    if (!uncommented.why_not.empty()) return uncommented.why_not;
    return Scan(uncommented.code).run().value_or("");
}

} // namespace postfx
