#include <postfx/error.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace postfx {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 1; i <= a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
            diagonal = row[j];
            row[j] = std::min({row[j] + 1, row[j - 1] + 1, replaced});
        }
    }
    return row.back();
}

} // namespace

std::string Place::text() const {
    std::string text = file;
    if (line > 0) text += fmt::format(":{}", line);
    if (line > 0 && column > 0) text += fmt::format(":{}", column);
    if (!effect.empty()) text += (text.empty() ? "" : ": ") + effect + (pass.empty() ? "" : "/" + pass);
    return text;
}

Error::Error(Place place, const std::string& message)
    : std::runtime_error(place.text().empty() ? message : place.text() + ": " + message),
      place_(std::move(place)), message_(message) {}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates) {
    const std::string* nearest = nullptr;
    std::size_t nearest_distance = std::max<std::size_t>(2, word.size() / 3) + 1;
    for (const std::string& candidate : candidates) {
        const std::size_t distance = edit_distance(word, candidate);
        if (distance < nearest_distance) {
            nearest = &candidate;
            nearest_distance = distance;
        }
    }
    return nearest ? fmt::format("; did you mean \"{}\"?", *nearest) : "";
}

} // namespace postfx
