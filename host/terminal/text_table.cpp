#include "text_table.hpp"

#include <algorithm>
#include <sstream>

namespace postfx::host {

std::string text_table(const std::vector<std::vector<std::string>>& rows, int indent) {
    std::vector<std::size_t> widths;
    for (const std::vector<std::string>& row : rows) {
        widths.resize(std::max(widths.size(), row.size()));
        for (std::size_t i = 0; i < row.size(); ++i)
            widths[i] = std::max(widths[i], row[i].size());
    }
    std::string text;
    for (const std::vector<std::string>& row : rows) {
        std::string line(static_cast<std::size_t>(indent), ' ');
        for (std::size_t i = 0; i < row.size(); ++i)
            line += row[i] + std::string(widths[i] - row[i].size() + 2, ' ');
        line.erase(line.find_last_not_of(' ') + 1);
        text += line + "\n";
    }
    return text;
}

std::string wrapped(const std::string& text, int indent, int width) {
    std::istringstream words(text);
    const std::string start(static_cast<std::size_t>(indent), ' ');
    std::string lines, line;
    for (std::string word; words >> word;) {
        const std::size_t length = start.size() + line.size() + 1 + word.size();
        if (!line.empty() && length > static_cast<std::size_t>(width)) {
            lines += start + line + "\n";
            line.clear();
        }
        line += (line.empty() ? "" : " ") + word;
    }
    return line.empty() ? lines : lines + start + line + "\n";
}

std::string markdown_cell(std::string text) {
    for (std::size_t at = text.find('|'); at != std::string::npos; at = text.find('|', at + 2))
        text.insert(at, 1, '\\');
    return text;
}

std::string markdown_row(const std::vector<std::string>& cells) {
    std::string line = "|";
    for (const std::string& cell : cells)
        line.append(cell.empty() ? "" : " ").append(cell).append(" |");
    return line.append("\n");
}

} // namespace postfx::host
