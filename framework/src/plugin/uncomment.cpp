#include <plugin/uncomment.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>

namespace postfx {
namespace {

std::string_view row_at(std::string_view text, std::size_t at) {
    return text.substr(at, std::min(text.find('\n', at), text.size()) - at);
}

std::string_view trimmed(std::string_view row) {
    while (!row.empty() && is_blank(row.front()))
        row.remove_prefix(1);
    while (!row.empty() && is_blank(row.back()))
        row.remove_suffix(1);
    return row;
}

class Uncommenter {
public:
    explicit Uncommenter(std::string_view text) : text_(text) {}

    /// Why not; nothing if `code()` can be believed.
    std::optional<std::string> run() {
        for (at_ = 0; at_ < text_.size(); ++at_) {
            const char c = text_[at_], next = at_ + 1 < text_.size() ? text_[at_ + 1] : '\0';
            if (c == '\\') return refuse("has a line continuation, which could hide a directive");
            if (c == '\r' && next != '\n') return refuse("has a carriage return inside a line");
            if (at_ == 0 || text_[at_ - 1] == '\n') {
                if (auto why = check_include(trimmed(row_at(text_, at_)))) return why;
            }
            step(c, next);
        }
        if (state_ == State::block) {
            line_ = opened_;
            return refuse("has a comment without an end");
        }
        return std::nullopt;
    }
    const std::string& code() const { return code_; }

private:
    enum class State { code, line, block };

    void step(char c, char next) {
        if (c == '\n') {
            ++line_;
            if (state_ == State::line) state_ = State::code;
            code_ += c;
        } else if (state_ == State::code && c == '/' && (next == '/' || next == '*')) {
            state_ = next == '/' ? State::line : State::block;
            opened_ = line_;
            blank_two();
        } else if (state_ == State::block && c == '*' && next == '/') {
            state_ = State::code;
            blank_two();
        } else {
            code_ += state_ == State::code ? c : ' ';
        }
    }

    void blank_two() {
        code_ += "  ";
        ++at_;
    }

    std::optional<std::string> check_include(std::string_view row) const {
        if (!row.starts_with("#include")) return std::nullopt;
        if (state_ == State::block) return refuse("has an #include in a comment");
        if (row.find("//") != std::string::npos || row.find("/*") != std::string::npos) {
            return refuse("has a comment behind an #include");
        }
        return std::nullopt;
    }

    std::string refuse(std::string_view why) const { return fmt::format("line {}: {}", line_, why); }

    std::string_view text_;
    std::string code_;
    std::size_t at_ = 0;
    State state_ = State::code;
    int line_ = 1, opened_ = 1;
};

} // namespace

bool is_word_character(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r';
}

Uncommented uncomment(std::string_view glsl) {
    Uncommenter uncommenter(glsl);
    if (const auto why = uncommenter.run()) return {"", *why};
    return {uncommenter.code(), ""};
}

} // namespace postfx
