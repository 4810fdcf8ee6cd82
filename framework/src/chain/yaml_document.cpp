#include "chain/yaml_document.hpp"

#include "base/yaml_scalars.hpp"
#include "base/yaml_text.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/mark.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <unordered_set>

namespace postfx {
namespace {

/// Where yaml-cpp says that something is; it counts from 0, and the end of the text is its "unknown".
std::size_t offset_of(const YAML::Mark& mark) {
    return mark.is_null() ? std::string_view::npos : static_cast<std::size_t>(mark.pos);
}

/// Does `after` stand behind `before` with just a comma between them?
bool stand_around_comma(const YamlNode& before, const YamlNode& after) {
    return before.is(YamlNode::Kind::scalar) && after.is(YamlNode::Kind::scalar) && !before.quoted
           && !after.quoted && before.place.line == after.place.line
           && before.place.column + static_cast<int>(before.text.size()) + 1 == after.place.column;
}

/// Builds the tree from the parser's events and stops it at the first thing that a chain file may not have.
class TreeBuilder : public YAML::EventHandler {
public:
    explicit TreeBuilder(const YamlText& source) : source_(source) { root_.place = source.place_of(0); }

    YamlNode take_root() { return std::move(root_); }

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (++document_count_ > 1) {
            throw Error(place_of(mark), "a second document starts here; expected one document");
        }
    }
    void OnDocumentEnd() override {}

    void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add(node(YamlNode::Kind::nothing, mark)); }
    void OnAnchor(const YAML::Mark& mark, const std::string& name) override {
        throw Error(place_of(mark),
                    fmt::format("anchors (&{}) are not supported; share values with \"include\"", name));
    }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
        throw Error(place_of(mark), "aliases (*) are not supported; share values with \"include\"");
    }
    void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                  const std::string& value) override {
        refuse_tag(mark, tag);
        YamlNode scalar = node(YamlNode::Kind::scalar, mark);
        scalar.text = value;
        scalar.quoted = tag == "!";
        add(std::move(scalar));
    }
    void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                         YAML::EmitterStyle::value) override {
        open(YamlNode::Kind::list, mark, tag);
    }
    void OnSequenceEnd() override { close(); }
    void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t,
                    YAML::EmitterStyle::value) override {
        open(YamlNode::Kind::map, mark, tag);
    }
    void OnMapEnd() override { close(); }

private:
    Place place_of(const YAML::Mark& mark) const { return source_.place_of(offset_of(mark)); }

    /// A list or map that has begun and not ended.
    struct Open {
        YamlNode node;
        std::optional<YamlNode> key; ///< map: waits for its value
        std::unordered_set<std::string> keys;
    };

    YamlNode node(YamlNode::Kind kind, const YAML::Mark& mark) {
        YamlNode made;
        made.kind = kind;
        made.place = place_of(mark);
        if (++node_count_ > YamlLimits::nodes) {
            throw Error(made.place, fmt::format("more than {} values, expected a chain", YamlLimits::nodes));
        }
        return made;
    }

    /// yaml-cpp gives "?" for a plain node without a tag and "!" for quoted text.
    void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
        if (tag.empty() || tag == "?" || tag == "!") return;
        throw Error(place_of(mark), fmt::format("tags ({}) are not supported", quote(tag)));
    }

    void open(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag) {
        refuse_tag(mark, tag);
        if (open_.size() == YamlLimits::depth) {
            throw Error(place_of(mark), fmt::format("nested more than {} deep", YamlLimits::depth));
        }
        open_.push_back({node(kind, mark), {}, {}});
    }

    void close() {
        YamlNode done = std::move(open_.back().node);
        open_.pop_back();
        add(std::move(done));
    }

    void add(YamlNode added) {
        if (open_.empty()) {
            root_ = std::move(added);
            return;
        }
        Open& parent = open_.back();
        if (parent.node.is(YamlNode::Kind::list)) {
            parent.node.items.push_back(std::move(added));
        } else if (!parent.key) {
            check_key(added, parent);
            parent.key = std::move(added);
        } else {
            if (added.is(YamlNode::Kind::nothing)) {
                refuse_decimal_comma(*parent.key, parent.node.members);
                added.place = parent.key->place;
            }
            parent.node.members.push_back({std::move(*parent.key), std::move(added)});
            parent.key.reset();
        }
    }

    /// {radius: 0,5} is a radius of 0 and a key 5 to YAML.
    static void refuse_decimal_comma(const YamlNode& key, const std::vector<YamlMember>& before) {
        if (before.empty() || !stand_around_comma(before.back().value, key)) return;
        const YamlNode& number = before.back().value;
        if (const std::string hint = comma_hint(number.text, key.text); !hint.empty()) {
            throw Error(number.place, fmt::format("{}: expected a number, found {}{}", before.back().key.text,
                                                  quote(number.text + "," + key.text), hint));
        }
    }

    static void check_key(const YamlNode& key, Open& parent) {
        if (!key.is(YamlNode::Kind::scalar)) {
            throw Error(key.place, fmt::format("expected a word as key, found {}", key.found()));
        }
        if (key.text == "<<") {
            throw Error(key.place, "merge keys (<<) are not supported; share values with \"include\"");
        }
        if (!parent.keys.insert(key.text).second) {
            throw Error(key.place, fmt::format("{} is given twice", quote(key.text)));
        }
    }

    const YamlText& source_;
    YamlNode root_;
    std::vector<Open> open_;
    std::size_t node_count_ = 0;
    int document_count_ = 0;
};

} // namespace

std::string YamlNode::found() const {
    switch (kind) {
    case Kind::nothing:
        return "nothing";
    case Kind::list:
        return "a list";
    case Kind::map:
        return "a map";
    case Kind::scalar:
        break;
    }
    return quoted ? "the text " + quote(text) : quote(text);
}

YamlNode parse_yaml(std::string_view text, const std::string& origin) {
    if (text.size() > YamlLimits::bytes) {
        throw Error(Place{.file = origin},
                    fmt::format("is larger than {} KiB, expected a chain", YamlLimits::bytes / 1024));
    }
    const YamlText source(text, origin);
    source.check_characters();

    TreeBuilder builder(source);
    try {
        std::istringstream stream{std::string(source.text())};
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (const YAML::Exception& error) {
        throw source.syntax_error(offset_of(error.mark), error.msg);
    }
    source.check_quotes();
    return builder.take_root();
}

std::string decimal_comma_hint(const std::vector<YamlNode>& items) {
    for (std::size_t i = 0; i + 1 < items.size(); ++i) {
        if (stand_around_comma(items[i], items[i + 1])) return comma_hint(items[i].text, items[i + 1].text);
    }
    return "";
}

std::string quote(std::string_view text) {
    constexpr std::size_t longest = 60;
    const bool cut = text.size() > longest;
    if (cut) {
        std::size_t end = longest;
        while (continues_character(text[end]))
            --end;
        text = text.substr(0, end);
    }
    std::string quoted = "\"";
    for (const char byte : text) {
        const bool control = static_cast<unsigned char>(byte) < 0x20 || byte == 0x7F;
        quoted += control ? ' ' : byte;
    }
    return quoted + (cut ? "...\"" : "\"");
}

} // namespace postfx
