// The one exception type that leaves the library.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace postfx {

/// Where something went wrong. Every part is optional: a file problem has `file` (and `line`, `column` when
/// the file is text; both count from 1, 0 = unknown), a problem of a running chain has `effect` and perhaps
/// `pass`.
struct Place {
    std::string file{};
    int line = 0;
    int column = 0;
    std::string effect{};
    std::string pass{};

    /// "chain.yaml:14:9", "glow/downsample", "picture.exr" or "".
    std::string text() const;
};

/// What went wrong, where, in one line: "chain.yaml:14:9: glow has no parameter "intensty"; did you mean
/// ...". `what()` is that whole line.
class Error : public std::runtime_error {
public:
    explicit Error(const std::string& message) : Error(Place{}, message) {}
    Error(Place place, const std::string& message);

    const Place& place() const { return place_; }
    /// The message without the place.
    const std::string& message() const { return message_; }

private:
    Place place_;
    std::string message_;
};

/// An effect refuses its values: they are no mistake of the effect's, so others would do.
class Refusal : public Error {
public:
    using Error::Error;
};

/// `; did you mean "x"?` for the candidate nearest to `word` (by edit distance), or "" when none is near.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

} // namespace postfx
