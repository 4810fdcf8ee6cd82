// What is told beside a result: one line each, on stderr.
#pragma once

#include <string>
#include <vector>

namespace postfx::host {

/// "postfx: FILE: line" for each, or nothing when `quiet`.
void tell_lines(const std::string& file, const std::vector<std::string>& lines, bool quiet);

/// The same, never quiet, for what was brought into shape; when `strict`, the first line is thrown as an Error instead.
void tell_or_refuse(const std::string& file, const std::vector<std::string>& warnings, bool strict);

} // namespace postfx::host
