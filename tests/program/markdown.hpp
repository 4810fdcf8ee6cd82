// Fenced code blocks of a Markdown page, so that what a page shows can be built and run.
#pragma once

#include "program.hpp"

#include <sstream>
#include <string>
#include <vector>

namespace postfx::testing {

/// ```cpp file=glow/glow.cpp  has the language "cpp" and the info "file=glow/glow.cpp".
struct CodeBlock {
    std::string language, info;
    std::string text;
    int line = 0; ///< of the page, from 1: the first line of the text

    /// What follows `key=` in the info, which holds nothing else; "" when the info is another one.
    std::string value(const std::string& key) const {
        return info.starts_with(key + "=") ? info.substr(key.size() + 1) : "";
    }
};

inline std::vector<CodeBlock> code_blocks(const std::filesystem::path& page) {
    std::istringstream rows(file_bytes(page));
    std::vector<CodeBlock> blocks;
    bool inside = false;
    int line = 0;
    for (std::string row; std::getline(rows, row);) {
        ++line;
        if (!row.starts_with("```")) {
            if (inside) blocks.back().text += row + "\n";
        } else if (inside) {
            inside = false;
        } else {
            const std::size_t space = std::min(row.find(' '), row.size());
            blocks.push_back(
                {row.substr(3, space - 3), row.substr(std::min(space + 1, row.size())), "", line + 1});
            inside = true;
        }
    }
    if (inside) throw std::runtime_error(page.string() + " ends inside a code block");
    return blocks;
}

/// Every run of blanks as one space: for tables whose columns may move.
inline std::string squeezed(const std::string& text) {
    std::istringstream words(text);
    std::string result;
    for (std::string word; words >> word;)
        result += (result.empty() ? "" : " ") + word;
    return result;
}

} // namespace postfx::testing
