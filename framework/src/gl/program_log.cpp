#include <gl/program_log.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <regex>

namespace postfx::gl {
namespace {

/// The first line that reports an error, else the first line: drivers put warnings and headings before
/// errors.
std::string first_error(const std::string& log) {
    const std::size_t word = std::min(log.find("error"), log.find("ERROR"));
    const std::size_t inside = word == std::string::npos ? 0 : word;
    const std::size_t before = log.rfind('\n', inside);
    const std::size_t first = before == std::string::npos ? 0 : before + 1;
    constexpr std::size_t longest = 2000; // std::regex recurses for every character
    const std::string line = log.substr(first, std::min(log.find('\n', inside) - first, longest));
    return line.empty() ? "the driver gives no reason" : line;
}

int number(const std::ssub_match& digits) {
    return digits.matched ? std::stoi(digits.str()) : 0;
}

} // namespace

NumberedSource::NumberedSource(std::string_view source) {
    Origin next;
    while (!source.empty()) {
        const std::size_t end = std::min(source.find('\n'), source.size() - 1);
        const std::string line(source.substr(0, end + 1));
        source.remove_prefix(end + 1);
        origins_.push_back(next);
        Origin named = next;
        if (std::sscanf(line.c_str(), " # line %d %zu", &named.line, &named.file) >= 1) {
            next = named;
            text_ += '\n';
        } else {
            ++next.line;
            text_ += line;
        }
    }
}

NumberedSource::Origin NumberedSource::origin(int line) const {
    if (origins_.empty()) return {};
    return origins_[static_cast<std::size_t>(std::clamp(line, 1, static_cast<int>(origins_.size())) - 1)];
}

Error program_error(const std::string& log, const std::string& what, const NumberedSource& source,
                    const std::vector<std::string>& files) {
    // Mesa "0:17(5): error: TEXT", NVIDIA "0(17) : error C1503: TEXT", others "ERROR: 0:17: TEXT".
    static const std::regex place_and_text(
        R"(^(?:ERROR: )?\d+(?::(\d{1,6})\((\d{1,6})\)|\((\d{1,6})\)|:(\d{1,6}))\s*:\s*(.*)$)");
    const std::string line = first_error(log);
    const std::string prefix = what.empty() ? "" : what + ": ";
    std::smatch parts;
    if (!std::regex_match(line, parts, place_and_text)) return Error(prefix + line);
    const int line_number =
        number(parts[1]) + number(parts[3]) + number(parts[4]); // one of the three matched
    const NumberedSource::Origin origin = source.origin(line_number);
    if (origin.file >= files.size()) return Error(prefix + line);
    Place place;
    place.file = files[origin.file];
    place.line = origin.line;
    place.column = number(parts[2]);
    return {place, prefix + parts[5].str()};
}

} // namespace postfx::gl
