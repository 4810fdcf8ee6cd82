// What reads GLSL word by word begins with.
#pragma once

#include <string>
#include <string_view>

namespace postfx {

bool is_word_character(char c);
/// A space within a line.
bool is_blank(char c);

struct Uncommented {
    std::string code;    ///< every character where it was, those of comments being spaces
    std::string why_not; ///< as "line 3: has a comment without an end"; empty if `code` can be believed
};

/// Takes comments out of GLSL. What a compiler might take for a comment where this does not, or the other way round,
/// is refused: continued lines, lone carriage returns, and #include lines (which are replaced as a whole before the
/// compiler sees the text) that begin or end a comment.
Uncommented uncomment(std::string_view glsl);

} // namespace postfx
