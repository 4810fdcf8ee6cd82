#include <postfx/chain.hpp>

#include "base/read_file.hpp"
#include "base/yaml_scalars.hpp"
#include "chain/read_value.hpp"
#include "chain/yaml_document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace postfx {
namespace {

namespace fs = std::filesystem;
using Kind = YamlNode::Kind;

constexpr std::size_t max_include_depth = 16;

const std::vector<std::string> section_keys = {"budget", "effects", "include", "overrides", "skip"};
const std::vector<std::string> entry_keys = {"enabled", "quality", "pin", "name"};

[[noreturn]] void refuse(const YamlNode& node, std::string_view subject, std::string_view expected,
                         const std::string& hint = "") {
    throw Error(node.place,
                fmt::format("{}: expected {}, found {}{}", subject, expected, node.found(), hint));
}

/// A key with nothing behind it means the defaults, so that a list whose items are all commented out stays
/// legal.
void expect(const YamlNode& node, Kind kind, std::string_view subject, std::string_view expected) {
    if (!node.is(kind) && !node.is(Kind::nothing)) refuse(node, subject, expected);
}

/// A map of an effect's settings, or nothing.
void expect_settings(const YamlNode& node, const EffectInfo& effect, const std::string& subject) {
    if (node.is(Kind::map) || node.is(Kind::nothing)) return;
    refuse(node, subject, "a map {parameter: value}",
           colon_hint(node.text, known_settings(effect, entry_keys)));
}

bool is_name(std::string_view name) {
    const auto is_letter = [](char c) { return c >= 'a' && c <= 'z'; };
    return !name.empty() && is_letter(name[0]) && std::all_of(name.begin(), name.end(), [&](char c) {
        return is_letter(c) || (c >= '0' && c <= '9') || c == '_';
    });
}

/// `key`: what the level is of, "quality" or "pin".
int read_level(const YamlNode& node, const EffectInfo& effect, const std::string& key) {
    const std::string subject = effect.id + "." + key;
    if (effect.levels.empty()) throw Error(node.place, effect.id + " has no quality levels");
    std::vector<std::string> known;
    for (const LevelInfo& level : effect.levels)
        known.push_back(level.id);

    const std::string expected = "one of " + join(known);
    if (!node.is(Kind::scalar)) refuse(node, subject, expected);
    const auto found = std::find(known.begin(), known.end(), node.text);
    if (found == known.end()) {
        throw Error(node.place, fmt::format("{}: expected {}, found {}{}", subject, expected, node.found(),
                                            did_you_mean(node.text, known)));
    }
    return static_cast<int>(found - known.begin());
}

/// One `key: value` of an effect: a parameter, `enabled`, `quality` or `pin`.
void read_setting(const YamlMember& setting, ChainEntry& entry) {
    const EffectInfo& effect = *entry.effect;
    const std::string& key = setting.key.text;
    if (key == "enabled") {
        entry.enabled = read_toggle(setting.value, effect.id + ".enabled");
    } else if (key == "quality" || key == "pin") {
        entry.level = read_level(setting.value, effect, key);
        entry.pinned = key == "pin";
    } else if (const auto index = effect.find_parameter(key)) {
        entry.values[*index] = read_value(setting.value, effect, effect.parameters[*index]);
    } else {
        throw Error(setting.key.place, unknown_parameter(effect, key, entry_keys));
    }
}

/// Both would set the level, one for good.
void refuse_quality_beside_pin(const YamlNode& settings, const EffectInfo& effect) {
    const YamlNode* first = nullptr;
    for (const YamlMember& setting : settings.members) {
        if (setting.key.text != "quality" && setting.key.text != "pin") continue;
        if (first != nullptr) {
            throw Error(setting.key.place,
                        fmt::format("{} has quality and pin; give quality, or pin to keep the level "
                                    "under a budget",
                                    effect.id));
        }
        first = &setting.key;
    }
}

void read_name(const YamlNode& node, const Chain& others, ChainEntry& entry) {
    const std::string subject = entry.effect->id + ".name";
    if (!node.is(Kind::scalar) || !is_name(node.text)) {
        refuse(node, subject, "lower-case letters, digits and _, a letter first");
    }
    const bool taken = std::any_of(others.entries.begin(), others.entries.end(),
                                   [&](const ChainEntry& other) { return other.name == node.text; });
    if (taken) {
        throw Error(node.place, fmt::format("{}: another effect of this chain has the name {}", subject,
                                            quote(node.text)));
    }
    entry.name = node.text;
}

ChainEntry& add_effect(const YamlNode& id, const Catalog& catalog, Chain& chain) {
    if (chain.entries.size() == max_chain_entries) {
        throw Error(id.place, fmt::format("more than {} effects in one chain", max_chain_entries));
    }
    try {
        return chain.add(catalog, id.text);
    } catch (const Error& error) {
        throw Error(id.place, error.message());
    }
}

/// An item that is a map holds one effect. What stands beside it is a setting that was not indented, or an
/// effect without its "- ".
void expect_one_effect(const YamlNode& item) {
    if (item.members.empty()) throw Error(item.place, "expected an effect, found an empty map");
    if (item.members.size() == 1) return;
    const YamlNode& effect = item.members[0].key;
    const YamlNode& beside = item.members[1].key;
    throw Error(beside.place,
                fmt::format("{} stands beside {}; indent it further if it belongs to {}, or begin a new "
                            "item with \"- \"",
                            quote(beside.text), quote(effect.text), quote(effect.text)));
}

/// One item of `effects:`, appended to the chain.
void read_item(const YamlNode& item, const Catalog& catalog, Chain& chain) {
    if (item.is(Kind::scalar)) {
        add_effect(item, catalog, chain);
        return;
    }
    if (!item.is(Kind::map))
        refuse(item, "an item of \"effects\"", "an effect, or \"effect: {parameter: value}\"");
    expect_one_effect(item);

    const auto& [id, settings] = item.members[0];
    ChainEntry entry = std::move(add_effect(id, catalog, chain));
    chain.entries.pop_back(); // its name is free again for its own `name:`
    expect_settings(settings, *entry.effect, entry.effect->id);
    refuse_quality_beside_pin(settings, *entry.effect);
    for (const YamlMember& setting : settings.members) {
        if (setting.key.text == "name") {
            read_name(setting.value, chain, entry);
        } else {
            read_setting(setting, entry);
        }
    }
    chain.entries.push_back(std::move(entry));
}

void read_override(const YamlMember& change, Chain& chain) {
    ChainEntry* entry = chain.find(change.key.text);
    if (entry == nullptr) {
        std::vector<std::string> names;
        for (const ChainEntry& known : chain.entries)
            names.push_back(known.name);
        throw Error(change.key.place,
                    fmt::format("the included chain has no entry {}{}", quote(change.key.text),
                                names.empty() ? "; it is empty" : nearest_or_all(change.key.text, names)));
    }
    expect_settings(change.value, *entry->effect, "override of " + entry->name);
    refuse_quality_beside_pin(change.value, *entry->effect);
    for (const YamlMember& setting : change.value.members) {
        if (setting.key.text == "name") {
            throw Error(setting.key.place, "an override can't change the name of an included effect");
        }
        read_setting(setting, *entry);
    }
}

Skip read_skip(const YamlNode& node) {
    if (const auto skip = node.is(Kind::scalar) ? skip_by_word(node.text) : std::nullopt) return *skip;
    refuse(node, "\"skip\"", "nothing, exact, code or visible");
}

double read_limit(const YamlNode& node, const std::string& subject) {
    const std::string expected = "a number above 0";
    const double limit = read_number(node, subject, expected);
    if (!(limit > 0) || std::isinf(limit)) refuse(node, subject, expected);
    return limit;
}

Budget read_budget(const YamlNode& node) {
    constexpr const char* expected = "{ms: MILLISECONDS} or {error: SHARE}";
    if (!node.is(Kind::map) || node.members.empty())
        refuse(node, "\"budget\"", expected, colon_hint(node.text, {"ms", "error"}));
    if (node.members.size() > 1) {
        throw Error(node.members[1].key.place,
                    fmt::format("\"budget\" has two keys; expected one of them: {}", expected));
    }
    const auto& [key, value] = node.members[0];
    for (const Budget::Of of : {Budget::Of::ms, Budget::Of::error}) {
        if (key.text == budget_word(of)) return {of, read_limit(value, "budget." + key.text)};
    }
    throw Error(key.place, fmt::format("\"budget\" has no key {}{}", quote(key.text),
                                       nearest_or_all(key.text, {"ms", "error"})));
}

/// The keys of a chain file; null where the file does not have one.
struct Sections {
    const YamlNode* include = nullptr;
    const YamlNode* overrides = nullptr;
    const YamlNode* effects = nullptr;
    const YamlNode* skip = nullptr;
    const YamlNode* budget = nullptr;
};

Sections split(const YamlNode& root) {
    if (root.is(Kind::nothing))
        throw Error(root.place, "the chain is empty; expected \"effects\" or \"include\"");
    if (!root.is(Kind::map)) {
        refuse(root, "a chain", "\"effects:\" and a list, or \"include:\" and a file",
               colon_hint(root.text, section_keys));
    }
    Sections sections;
    const YamlNode* overrides_key = nullptr;
    for (const auto& [key, value] : root.members) {
        if (key.text == "include") {
            sections.include = &value;
        } else if (key.text == "overrides") {
            sections.overrides = &value;
            overrides_key = &key;
        } else if (key.text == "effects") {
            sections.effects = &value;
        } else if (key.text == "skip") {
            sections.skip = &value;
        } else if (key.text == "budget") {
            sections.budget = &value;
        } else {
            throw Error(key.place, fmt::format("a chain has no key {}{}", quote(key.text),
                                               nearest_or_all(key.text, section_keys)));
        }
    }
    if (overrides_key != nullptr && sections.include == nullptr) {
        throw Error(overrides_key->place, "\"overrides\" needs \"include\": it changes included effects");
    }
    if (sections.include == nullptr && sections.effects == nullptr) {
        throw Error(root.place, "expected \"effects\" or \"include\", found neither");
    }
    return sections;
}

/// Reads files that include files. Remembers which are open, outermost first.
class Reader {
public:
    Reader(const Catalog& catalog, const std::vector<fs::path>& include_directories)
        : catalog_(catalog), include_directories_(include_directories) {}

    Chain read(const std::string& yaml, const fs::path& origin) {
        open_.push_back({origin, identity(origin)});
        const YamlNode root = parse_yaml(yaml, origin.string());
        const Sections sections = split(root);
        Chain chain;
        if (sections.include != nullptr) chain = read_included(*sections.include);
        if (sections.overrides != nullptr) {
            expect(*sections.overrides, Kind::map, "\"overrides\"", "a map {name: {parameter: value}}");
            for (const YamlMember& change : sections.overrides->members)
                read_override(change, chain);
        }
        if (sections.skip != nullptr) chain.skip = read_skip(*sections.skip);
        if (sections.budget != nullptr) chain.budget = read_budget(*sections.budget);
        if (sections.effects != nullptr) {
            expect(*sections.effects, Kind::list, "\"effects\"", "a list of effects");
            for (const YamlNode& item : sections.effects->items)
                read_item(item, catalog_, chain);
        }
        open_.pop_back();
        return chain;
    }

private:
    struct OpenFile {
        fs::path shown;    ///< as messages name it
        fs::path identity; ///< the same for all ways to write a path
    };

    static fs::path identity(const fs::path& file) {
        std::error_code ignored; // a chain from text may have an origin that is no path
        const fs::path canonical = fs::weakly_canonical(fs::absolute(file, ignored), ignored);
        return canonical.empty() ? file : canonical;
    }

    Chain read_included(const YamlNode& include) {
        if (!include.is(Kind::scalar) || include.text.empty())
            refuse(include, "\"include\"", "the name of a chain file");
        const fs::path file = find_included(include.text);
        refuse_cycle(file, include);
        if (open_.size() == max_include_depth) {
            throw Error(include.place,
                        fmt::format("more than {} files include each other", max_include_depth));
        }
        std::string yaml;
        try {
            yaml = read_file(file, YamlLimits::bytes, "a chain");
        } catch (const Error& error) {
            throw Error(include.place,
                        fmt::format("can't include {}: {}", quote(include.text), error.message()));
        }
        return read(yaml, file);
    }

    /// Beside the including file, else in the include directories; where it is nowhere, beside the file.
    fs::path find_included(const std::string& name) const {
        fs::path beside = (folder_of(open_.back().shown) / name).lexically_normal();
        if (fs::exists(beside)) return beside;
        for (const fs::path& directory : include_directories_) {
            if (fs::exists(directory / name)) return directory / name;
        }
        return beside;
    }

    void refuse_cycle(const fs::path& file, const YamlNode& include) const {
        const fs::path wanted = identity(file);
        const auto first = std::find_if(open_.begin(), open_.end(),
                                        [&](const OpenFile& open) { return open.identity == wanted; });
        if (first == open_.end()) return;
        std::string loop;
        for (auto open = first; open != open_.end(); ++open)
            loop += open->shown.string() + " -> ";
        throw Error(include.place,
                    fmt::format("files include each other in a circle: {}{}", loop, file.string()));
    }

    const Catalog& catalog_;
    const std::vector<fs::path>& include_directories_;
    std::vector<OpenFile> open_;
};

} // namespace

Chain read_chain(const fs::path& file, const Catalog& catalog,
                 const std::vector<fs::path>& include_directories) {
    return parse_chain(read_file(file, YamlLimits::bytes, "a chain"), input_name(file), catalog,
                       include_directories);
}

Chain parse_chain(const std::string& yaml, const fs::path& origin, const Catalog& catalog,
                  const std::vector<fs::path>& include_directories) {
    return Reader(catalog, include_directories).read(yaml, origin);
}

Budget parse_budget(const std::string& text, const std::string& origin) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
        throw Error(Place{.file = origin},
                    fmt::format("expected ms=MILLISECONDS or error=SHARE, found {}", quote(text)));
    return read_budget(
        parse_yaml(fmt::format("{}: {}", text.substr(0, equals), text.substr(equals + 1)), origin));
}

void parse_chain_entry(const std::string& yaml, const std::string& origin, const Catalog& catalog,
                       Chain& chain) {
    const YamlNode item = parse_yaml(yaml, origin);
    if (item.is(Kind::nothing)) throw Error(item.place, "expected an effect, found nothing");
    read_item(item, catalog, chain);
}

} // namespace postfx
