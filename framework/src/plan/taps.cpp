#include <plan/taps.hpp>

#include <plugin/uncomment.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

namespace postfx {
namespace {

constexpr std::array queries = {"textureSize", "textureQueryLod", "textureQueryLevels", "textureSamples",
                                "imageSize",   "imageSamples",    "imageStore"};

/// "texture", "textureLod", "texelFetchOffset", "imageAtomicAdd" ...; names that GLSL might have one day count too.
bool is_read(std::string_view word) {
    if (std::find(queries.begin(), queries.end(), word) != queries.end()) return false;
    const auto goes_on =
        [&](std::string_view start) { // with a new word: "image2D" is a type, "textured" nothing
            return word.size() > start.size() && word.starts_with(start)
                   && std::isupper(static_cast<unsigned char>(word[start.size()]));
        };
    return word == "texture" || goes_on("texture") || word == "texelFetch" || goes_on("texelFetch")
           || goes_on("image");
}

/// Writes GLSL without comments again, word by word.
class Rewriting {
public:
    Rewriting(std::string_view code, int line) : code_(code), line_(line) {}

    CountedText run() {
        while (at_ < code_.size() && result_.why_not.empty()) {
            const char c = code_[at_];
            if (c == '#') {
                directive();
            } else if (is_word_character(c)) {
                word(take_word());
            } else {
                mark(c);
                ++at_;
            }
        }
        if (!ends_read_.empty()) refuse("leaves a bracket open");
        return std::move(result_);
    }

private:
    template<class... Args>
    void refuse(fmt::format_string<Args...> format, Args&&... args) {
        if (!result_.why_not.empty()) return; // the first reason is the one
        result_.why_not = fmt::format("line {}: {}", line_, fmt::format(format, std::forward<Args>(args)...));
    }

    std::string_view take_word() {
        const std::size_t start = at_;
        while (at_ < code_.size() && is_word_character(code_[at_]))
            ++at_;
        return code_.substr(start, at_ - start);
    }

    /// Only what a macro stands for is code.
    void directive() {
        const std::string_view row = code_.substr(at_, std::min(code_.find('\n', at_), code_.size()) - at_);
        at_ += row.size();
        std::size_t start = 1;
        while (start < row.size() && is_blank(row[start]))
            ++start;
        const std::string_view rest = row.substr(start);
        if (rest.starts_with("extension")) return refuse("has the directive #extension");
        if (!rest.starts_with("define")) {
            result_.glsl += row;
            return;
        }
        if (rest.find('#') != std::string_view::npos) return refuse("makes words in a macro");
        CountedText definition = Rewriting(rest, line_).run();
        result_.why_not = definition.why_not;
        result_.glsl += "#" + definition.glsl;
    }

    void word(std::string_view word) {
        if (word == "discard") {
            result_.glsl += "do { postfx_tell_taps(); discard; } while (false)";
        } else if (is_read(word)) {
            const std::size_t next = code_.find_first_not_of(" \t\r\n", at_);
            // As a macro's argument, say, it would be called where it can't be seen.
            if (next == std::string_view::npos || code_[next] != '(')
                return refuse("names {} without calling it", word);
            result_.glsl += fmt::format("(++postfx_taps, {}", word);
            read_begins_ = true;
        } else {
            result_.glsl += word;
        }
    }

    void mark(char c) {
        result_.glsl += c;
        if (c == '\n') {
            ++line_;
        } else if (c == '(') {
            ends_read_.push_back(read_begins_);
            read_begins_ = false;
        } else if (c == ')') {
            if (ends_read_.empty()) return refuse("closes a bracket that is not open");
            if (ends_read_.back()) result_.glsl += ')';
            ends_read_.pop_back();
        }
    }

    std::string_view code_;
    std::size_t at_ = 0;
    int line_;
    CountedText result_;
    bool read_begins_ = false;    ///< with the next bracket
    std::vector<bool> ends_read_; ///< per open bracket: does it hold the arguments of a read?
};

} // namespace

// A sum of 64 bits: 8 megapixels with some hundred reads each are too many for 32.
const std::string_view tap_counter = R"(uint postfx_taps = 0u;
layout(std430, binding = 0) buffer PostfxTaps { uint low, high; } postfx_pass_taps;
void postfx_tell_taps() {
    uint before = atomicAdd(postfx_pass_taps.low, postfx_taps);
    if (before > 0xffffffffu - postfx_taps) atomicAdd(postfx_pass_taps.high, 1u);
}
#define main postfx_main
)";

const std::string_view tap_counting_main = R"(#undef main
void main() {
    postfx_main();
    postfx_tell_taps();
}
)";

CountedText count_taps(std::string_view glsl) {
    const Uncommented uncommented = uncomment(glsl);
    if (!uncommented.why_not.empty()) return {"", uncommented.why_not};
    return Rewriting(uncommented.code, 1).run();
}

} // namespace postfx
