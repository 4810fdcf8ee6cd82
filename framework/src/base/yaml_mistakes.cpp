#include "base/yaml_mistakes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace postfx {
namespace {

using std::string_view;

constexpr string_view blanks = " \t\r";

string_view trimmed(string_view text) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

bool is_word(string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
}

char closing(char opening) {
    return opening == '[' ? ']' : '}';
}

/// One line of the text.
struct Line {
    std::size_t offset = 0;
    string_view text;

    std::size_t indent() const { return std::min(text.find_first_not_of(" \t"), text.size()); }
    /// Without indentation, "- " of list items and comment.
    string_view content() const {
        string_view rest = trimmed(text.substr(0, text.find(" #")));
        while (rest.starts_with("- "))
            rest = trimmed(rest.substr(2));
        return rest.starts_with('#') ? string_view() : rest;
    }
    std::size_t offset_of(string_view part) const {
        return offset + static_cast<std::size_t>(part.data() - text.data());
    }
};

Line line_at(string_view text, std::size_t offset) {
    offset = std::min(offset, text.size());
    const std::size_t start = offset == 0 ? 0 : text.rfind('\n', offset - 1) + 1; // npos + 1 is 0
    return {start, text.substr(start, text.substr(start).find('\n'))};
}

/// The last line before `line` that holds anything.
std::optional<Line> line_before(string_view text, Line line) {
    while (line.offset > 0) {
        line = line_at(text, line.offset - 1);
        if (!line.content().empty()) return line;
    }
    return std::nullopt;
}

/// Follows quotes and brackets through the text as a YAML scanner does, and remembers what does not fit.
class Scanner {
public:
    explicit Scanner(string_view text) : text_(text) { scan(); }

    /// What is never closed, or closed by the wrong bracket.
    const std::optional<YamlMistake>& unclosed() const { return unclosed_; }
    /// The first quoted text that goes on over a line's end, which is legal, but seldom meant.
    std::optional<std::size_t> quote_over_lines() const { return quote_over_lines_; }

private:
    void scan() {
        while (at_ < text_.size() && !unclosed_) {
            const char c = text_[at_];
            if (c == '#' && is_blank_before()) {
                skip_line();
            } else if ((c == '"' || c == '\'') && starts_value()) {
                skip_quoted(c);
            } else if ((c == '|' || c == '>') && open_.empty() && starts_value()) {
                skip_block_text();
            } else {
                follow_bracket(c);
                step(c);
            }
        }
        if (!unclosed_ && !open_.empty()) {
            unclosed_ = {open_.back(),
                         fmt::format("the \"{}\" that opens here is never closed", text_[open_.back()])};
        }
    }

    void step(char c) {
        if (c == '\n') {
            last_ = 0;
        } else if (blanks.find(c) == string_view::npos) {
            last_ = c;
        }
        ++at_;
    }

    bool is_blank_before() const {
        return at_ == 0 || text_[at_ - 1] == '\n' || blanks.find(text_[at_ - 1]) != string_view::npos;
    }

    /// Can a value begin here, so that a quote or bracket is one? Not in the midst of a word.
    bool starts_value() const {
        if (last_ == 0) return true;
        if (!open_.empty() && (last_ == '[' || last_ == '{' || last_ == ',' || last_ == ':')) return true;
        return is_blank_before() && (last_ == '-' || last_ == ':' || last_ == '?');
    }

    void skip_line() { at_ = std::min(text_.find('\n', at_), text_.size()); }

    void skip_quoted(char quote) {
        const std::size_t start = at_;
        for (++at_; at_ < text_.size(); ++at_) {
            if (quote == '"' && text_[at_] == '\\') {
                ++at_;
            } else if (text_[at_] == quote) {
                const bool doubled = quote == '\'' && text_.substr(at_ + 1).starts_with('\'');
                if (!doubled) break;
                ++at_;
            } else if (text_[at_] == '\n' && !quote_over_lines_) {
                quote_over_lines_ = start;
            }
        }
        if (at_ >= text_.size()) unclosed_ = {start, "the quote that opens here is never closed"};
        last_ = quote;
        ++at_;
    }

    /// "|" or ">": what is indented further than its line is text.
    void skip_block_text() {
        const std::size_t indent = line_at(text_, at_).indent();
        for (skip_line(); at_ < text_.size(); skip_line()) {
            const Line next = line_at(text_, at_ + 1);
            if (!trimmed(next.text).empty() && next.indent() <= indent) return;
            ++at_;
        }
    }

    void follow_bracket(char c) {
        if ((c == '[' || c == '{') && (!open_.empty() || starts_value())) {
            open_.push_back(at_);
        } else if ((c == ']' || c == '}') && !open_.empty()) {
            const char opening = text_[open_.back()];
            if (closing(opening) != c) {
                unclosed_ = {
                    open_.back(),
                    fmt::format("the \"{}\" that opens here is not closed before \"{}\"", opening, c)};
            }
            open_.pop_back();
        }
    }

    string_view text_;
    std::size_t at_ = 0;
    char last_ = 0; ///< last character of the line that is no blank; 0 = none yet
    std::vector<std::size_t> open_;
    std::optional<YamlMistake> unclosed_;
    std::optional<std::size_t> quote_over_lines_;
};

std::optional<YamlMistake> find_tab(const Line& line) {
    const std::size_t tab = line.text.substr(0, line.indent()).find('\t');
    if (tab == string_view::npos) return std::nullopt;
    return YamlMistake{line.offset + tab, "a tab indents this line; YAML wants spaces"};
}

YamlMistake colon_missing(std::size_t offset, string_view word) {
    return {offset, fmt::format("a colon is missing behind \"{}\"", word)};
}

/// `glow {intensity: 1}`: a word with a bracket behind it, which is all one word to a parser.
std::optional<YamlMistake> find_word_before_bracket(const Line& line) {
    const string_view content = line.content();
    for (std::size_t bracket = content.find_first_of("{["); bracket != string_view::npos;
         bracket = content.find_first_of("{[", bracket + 1)) {
        const string_view before = trimmed(content.substr(0, bracket));
        const std::size_t start = before.find_last_of(" \t{[,") + 1; // npos + 1 is 0
        const string_view word = before.substr(start);
        if (is_word(word)) return colon_missing(line.offset_of(word), word);
    }
    return std::nullopt;
}

/// `glow` on a line of its own, with its settings indented below.
std::optional<YamlMistake> find_word_above(string_view text, const Line& line) {
    const std::optional<Line> above = line_before(text, line);
    if (!above || !is_word(above->content())) return std::nullopt;
    const bool is_item = trimmed(line.text).starts_with("- "); // may stand as far left as its key
    if (line.indent() < above->indent() + (is_item ? 0 : 1)) return std::nullopt;
    return colon_missing(above->offset_of(above->content()), above->content());
}

/// `glow: intensity: 1`
std::optional<YamlMistake> find_second_key(const Line& line, std::size_t refused) {
    const std::size_t first = line.text.find(": ");
    const std::size_t second = line.text.find(": ", first == string_view::npos ? first : first + 2);
    if (second == string_view::npos || line.text.find_first_of("{[") < second) return std::nullopt;
    return YamlMistake{refused,
                       "a second key stands on this line; give it a line of its own, indented further, or "
                       "write {key: value}"};
}

/// `{intensity: 1 radius: 2}`
std::optional<YamlMistake> find_missing_comma(const Line& line, std::size_t refused) {
    const string_view before = line.text.substr(0, refused - line.offset);
    const std::size_t opening = before.find_last_of("{[,");
    if (opening == string_view::npos) return std::nullopt;
    const string_view item = line.text.substr(opening + 1);
    const std::size_t first = item.find(": ");
    if (first == string_view::npos) return std::nullopt;
    const std::size_t second = item.find(": ", first + 2);
    if (second == string_view::npos || item.find_first_of("{[]},") < second) return std::nullopt;
    const string_view words = trimmed(item.substr(0, second));
    const string_view word = words.substr(words.find_last_of(blanks) + 1);
    return YamlMistake{line.offset_of(word), fmt::format("a comma is missing before \"{}\"", word)};
}

std::optional<YamlMistake> find_stray_bracket(string_view text, std::size_t refused) {
    if (refused >= text.size() || (text[refused] != ']' && text[refused] != '}')) return std::nullopt;
    return YamlMistake{refused, fmt::format("\"{}\" closes nothing that was opened", text[refused])};
}

} // namespace

std::optional<YamlMistake> find_yaml_mistake(string_view text, std::size_t refused) {
    refused = std::min(refused, text.size());
    const Line line = line_at(text, refused);
    if (auto mistake = find_tab(line)) return mistake;
    const Scanner scanner(text);
    if (scanner.quote_over_lines() && *scanner.quote_over_lines() < refused) {
        return YamlMistake{*scanner.quote_over_lines(),
                           "the quote that opens here is not closed on its line"};
    }
    if (scanner.unclosed()) return scanner.unclosed();
    if (auto mistake = find_word_before_bracket(line)) return mistake;
    if (auto mistake = find_word_above(text, line)) return mistake;
    if (auto mistake = find_second_key(line, refused)) return mistake;
    if (auto mistake = find_missing_comma(line, refused)) return mistake;
    return find_stray_bracket(text, refused);
}

std::optional<YamlMistake> find_unclosed_quote(string_view text) {
    const Scanner scanner(text);
    const auto& unclosed = scanner.unclosed();
    const bool is_quote = unclosed && (text[unclosed->offset] == '\'' || text[unclosed->offset] == '"');
    return is_quote ? unclosed : std::nullopt;
}

} // namespace postfx
