// The text of a YAML file: the places in it, and what is wrong where a parser gave up.
#pragma once

#include <postfx/error.hpp>

#include <cstddef>
#include <string>
#include <string_view>

namespace postfx {

/// Lines and columns count from 1, columns in characters, not bytes. The text has to stay.
class YamlText {
public:
    /// `origin`: the file's name in messages. A byte order mark is left out.
    YamlText(std::string_view text, std::string origin);

    /// Without the byte order mark; offsets count from here.
    std::string_view text() const { return text_; }

    /// Cheap when it is asked for places in their order in the text: it counts on from the last one.
    Place place_of(std::size_t offset) const;

    /// Throws Error for what a parser should not see: control characters (yaml-cpp takes byte 4 for the end of the
    /// file), and text that is not UTF-8.
    void check_characters() const;

    /// Throws Error for a quote that is never closed, although a parser took the text.
    void check_quotes() const;

    /// Why the text is no YAML, when a parser stopped at `offset` and said `complaint`: an unclosed quote or bracket, a
    /// missing colon, a tab, where that explains it, at the place where it is; else the complaint.
    Error syntax_error(std::size_t offset, const std::string& complaint) const;

private:
    struct Counted {
        std::size_t offset = 0;
        int line = 1;
        int column = 1;
    };

    std::string_view text_;
    std::string origin_;
    mutable Counted counted_;
};

/// Is the byte one of those that follow the first of a UTF-8 character?
bool continues_character(char byte);

} // namespace postfx
