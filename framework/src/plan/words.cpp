// The words of a plan's enums.
#include <base/words.hpp>

#include <postfx/plan.hpp>

namespace postfx {
namespace {

constexpr Words<3> status_words = {"ran", "fused", "skipped"};
constexpr Words<3> moment_words = {"configuration", "scene", "frame"};
constexpr Words<4> skip_kind_words = {"exact", "code", "visible", "lacks"};

} // namespace

std::string_view status_name(EffectStatus status) {
    return word_among(status_words, status);
}

std::string_view moment_word(Moment moment) {
    return word_among(moment_words, moment);
}

std::optional<Moment> moment_by_word(std::string_view word) {
    return value_among<Moment>(moment_words, word);
}

std::string_view skip_kind_word(SkipKind kind) {
    return word_among(skip_kind_words, kind);
}

std::optional<SkipKind> skip_kind_by_word(std::string_view word) {
    return value_among<SkipKind>(skip_kind_words, word);
}

} // namespace postfx
