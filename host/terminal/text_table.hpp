// Text for people: aligned columns and wrapped lines for the terminal, cells of Markdown tables.
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

/// A cell of a Markdown table.
std::string markdown_cell(std::string text);

/// "| a | b |\n" of cells that are Markdown already.
std::string markdown_row(const std::vector<std::string>& cells);

} // namespace postfx::host
