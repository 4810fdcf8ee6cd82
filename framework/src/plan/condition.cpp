#include <plan/condition.hpp>

#include <algorithm>

namespace postfx {

std::optional<Condition> both(const Condition& a, const Condition& b) {
    if (a.empty()) return b;
    if (b.empty()) return a;
    Condition terms;
    for (const Term& x : a) {
        for (const Term& y : b) {
            const Term term{x.live | y.live, x.dead | y.dead};
            const bool known = std::find(terms.begin(), terms.end(), term) != terms.end();
            if ((term.live & term.dead) == 0 && !known) terms.push_back(term);
        }
    }
    if (terms.empty()) return std::nullopt;
    return terms;
}

bool holds(const Condition& condition, std::uint32_t live) {
    return condition.empty() || std::any_of(condition.begin(), condition.end(), [&](const Term& term) {
               return (live & term.live) == term.live && (live & term.dead) == 0;
           });
}

} // namespace postfx
