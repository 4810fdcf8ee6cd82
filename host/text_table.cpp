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

} // namespace postfx::host
