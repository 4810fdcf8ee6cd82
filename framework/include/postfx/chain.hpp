// A chain: which effects, in which order, with which values. Read from YAML or made in code.
#pragma once

#include <postfx/catalog.hpp>

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace postfx {

/// One effect of a chain with its values.
struct ChainEntry {
    EffectPtr effect;
    /// Unique in the chain: the effect's id, "<id>_2" for the second of the same effect, or what `name:` says.
    std::string name;
    bool enabled = true;
    int level = 0;             ///< index into effect->levels
    bool pinned = false;       ///< a budget leaves the level as it is
    std::vector<Value> values; ///< one per parameter of the effect, within range

    /// Set a value (all channels of a color); ints, toggles and choices are rounded. Out of range it is
    /// clamped and false is returned; NaN changes nothing and returns false. Throws Error for an unknown
    /// parameter.
    bool set(std::string_view parameter, double value);
};

/// Which work may be left out when it is not called for: up to what it would change in the picture.
enum class Skip {
    nothing, ///< all that is enabled runs, to prove that skipping is harmless
    exact,   ///< no bit
    code,    ///< at most one 8-bit code
    visible, ///< what by convention is not seen
};
std::string_view skip_word(Skip skip);
/// By its word. Nothing when there is none.
std::optional<Skip> skip_by_word(std::string_view word);

/// What the picture may cost, or how far it may be from the truth; levels are chosen accordingly (budget.hpp).
struct Budget {
    enum class Of {
        ms,    ///< milliseconds for the whole chain, of the clock that measured the curves
        error, ///< relative root mean square, as curves have it
    };
    Of of = Of::ms;
    double limit = 0; ///< above 0, finite
    bool operator==(const Budget&) const = default;
};
std::string_view budget_word(Budget::Of of);

struct Chain {
    std::vector<ChainEntry> entries;
    Skip skip = Skip::code;
    std::optional<Budget> budget = {};

    /// Append an effect with its defaults. Throws Error when the catalog has none of that id.
    ChainEntry& add(const Catalog& catalog, std::string_view effect_id);
    /// Null when there is none of that name.
    ChainEntry* find(std::string_view name);
};

/// Effects in one chain file with its includes; more is refused.
inline constexpr std::size_t max_chain_entries = 256;

/// Read a chain file. Throws Error with file:line:column, what was expected and the nearest name.
///
///     include: default.yaml      # another chain, beside this file or in an include directory; its effects come first
///     overrides:                 # by entry name: values, enabled, quality and pin of included effects
///       dust: {amount: 0}
///     skip: code                 # nothing, exact, code or visible: see Skip; the included chain's unless given
///     budget: {ms: 6}            # or {error: 0.01}: see Budget; the included chain's unless given
///     effects:                   # optional when include is there
///       - shade                  # with its defaults
///       - blur: {radius: 0.2, quality: high, enabled: true, name: haze}
///       - haze: {pin: low}       # as quality, but no budget changes it
///
/// A file is UTF-8 of at most 1 MiB, nested at most 16 deep, without YAML's anchors, aliases, merge keys and
/// tags; at most 16 files include each other. Lines and columns count from 1, columns in characters.
Chain read_chain(const std::filesystem::path& file, const Catalog& catalog,
                 const std::vector<std::filesystem::path>& include_directories = {});

/// The same from text; `origin` names it in messages and anchors relative includes.
Chain parse_chain(const std::string& yaml, const std::filesystem::path& origin, const Catalog& catalog,
                  const std::vector<std::filesystem::path>& include_directories = {});

/// One item of `effects:`, e.g. "blur: {radius: 0.2}" or "shade", appended to `chain`.
void parse_chain_entry(const std::string& yaml, const std::string& origin, const Catalog& catalog,
                       Chain& chain);

/// "ms=6" or "error=0.01". Throws Error that says what was expected.
Budget parse_budget(const std::string& text, const std::string& origin);

/// JSON Schema (draft 2020-12) of the chain file, from the effects found; as text with 2-space indent.
std::string chain_schema(const Catalog& catalog);

} // namespace postfx
