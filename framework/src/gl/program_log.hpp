// From a driver's compile log back to the author's file and line.
#pragma once

#include <postfx/error.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace postfx::gl {

/// A shader's text without its #line directives, and what they said. Drivers are not given them: Mesa 22
/// reports source string 0 for undeclared names wherever they are, and drivers differ on whether #line N
/// numbers this line or the next.
class NumberedSource {
public:
    struct Origin {
        std::size_t file = 0; ///< source-string number
        int line = 1;
    };

    /// `#line N S`: the next line is line N of source string S.
    explicit NumberedSource(std::string_view source);

    /// The same number of lines, those of directives empty.
    const std::string& text() const { return text_; }
    /// Where line `line` of text() came from; counts from 1, past the end counts as the last.
    Origin origin(int line) const;

private:
    std::string text_;
    std::vector<Origin> origins_; ///< by line
};

/// The first error of a driver's log about `source`: place.file (of `files`, by source-string number) and
/// line where the log names a line; `what` names the program.
Error program_error(const std::string& log, const std::string& what, const NumberedSource& source,
                    const std::vector<std::string>& files);

} // namespace postfx::gl
