// Plain text for the terminal: aligned columns, wrapped lines.
#pragma once

#include <string>
#include <vector>

namespace postfx::host {

/// Rows of cells as lines, each starting with `indent` spaces, columns as wide as their widest cell and two
/// spaces apart. Cells must be ASCII or of one column per byte.
std::string text_table(const std::vector<std::vector<std::string>>& rows, int indent);

/// `text` broken at spaces into lines of at most `width` characters, each starting with `indent` spaces. A
/// longer word stays whole.
std::string wrapped(const std::string& text, int indent, int width = 100);

} // namespace postfx::host
