#include "chain/yaml_document.hpp"

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

bool continues_character(char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0) == 0x80;
}

/// Length in bytes of the UTF-8 character that `text` starts with, 0 when there is none: cut short, overlong,
/// a surrogate or above U+10FFFF (RFC 3629).
std::size_t utf8_length(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text[0]);
    if (lead < 0x80) return 1;
    const std::size_t length = lead >= 0xC2 && lead < 0xE0   ? 2
                               : lead >= 0xE0 && lead < 0xF0 ? 3
                               : lead >= 0xF0 && lead < 0xF5 ? 4
                                                             : 0;
    if (length == 0 || text.size() < length) return 0;
    if (!std::all_of(text.begin() + 1, text.begin() + static_cast<std::ptrdiff_t>(length),
                     continues_character)) {
        return 0;
    }
    const auto second = static_cast<unsigned char>(text[1]);
    const bool overlong = (lead == 0xE0 && second < 0xA0) || (lead == 0xF0 && second < 0x90);
    const bool not_a_character = (lead == 0xED && second >= 0xA0) || (lead == 0xF4 && second >= 0x90);
    return overlong || not_a_character ? 0 : length;
}

/// The text of one file and the places in it. Lines and columns count from 1, columns in characters, not
/// bytes.
class Source {
public:
    Source(std::string_view text, const std::string& origin) : text_(text), origin_(origin) {}

    /// Cheap when it is asked for places in their order in the text: it counts on from the last one.
    Place place_of(std::size_t offset) const {
        offset = std::min(offset, text_.size());
        if (offset < counted_.offset) counted_ = {};
        for (; counted_.offset < offset; ++counted_.offset) {
            if (text_[counted_.offset] == '\n') {
                ++counted_.line;
                counted_.column = 1;
            } else if (!continues_character(text_[counted_.offset])) {
                ++counted_.column;
            }
        }
        return {.file = origin_, .line = counted_.line, .column = counted_.column};
    }

    Place place_of(const YAML::Mark& mark) const {
        if (mark.is_null()) return {.file = origin_};
        return place_of(static_cast<std::size_t>(mark.pos));
    }

    /// Whether the line of that place is indented with a tab somewhere.
    bool has_tab_in_indentation(const YAML::Mark& mark) const {
        const std::size_t offset =
            mark.is_null() ? 0 : std::min(static_cast<std::size_t>(mark.pos), text_.size());
        const std::size_t line_start = text_.substr(0, offset).rfind('\n') + 1; // npos + 1 is 0
        const std::string_view line = text_.substr(line_start);
        return line.substr(0, line.find_first_not_of(" \t")).find('\t') != std::string_view::npos;
    }

    /// Throws for what yaml-cpp should not see: it takes byte 4 for the end of the file, and other encodings
    /// by guess.
    void check_characters() const {
        for (std::size_t offset = 0; offset < text_.size();) {
            const auto byte = static_cast<unsigned char>(text_[offset]);
            if ((byte < 0x20 && byte != '\t' && byte != '\n' && byte != '\r') || byte == 0x7F) {
                throw Error(place_of(offset),
                            fmt::format("expected plain text in UTF-8, found the byte 0x{:02X}", byte));
            }
            const std::size_t length = utf8_length(text_.substr(offset));
            if (length == 0) {
                throw Error(
                    place_of(offset),
                    fmt::format("expected text in UTF-8, found the byte 0x{:02X} out of place", byte));
            }
            offset += length;
        }
    }

private:
    struct Counted {
        std::size_t offset = 0;
        int line = 1;
        int column = 1;
    };

    std::string_view text_;
    std::string origin_;
    mutable Counted counted_;
};

/// Builds the tree from the parser's events and stops it at the first thing that a chain file may not have.
class TreeBuilder : public YAML::EventHandler {
public:
    explicit TreeBuilder(const Source& source) : source_(source) {
        root_.place = source.place_of(std::size_t{0});
    }

    YamlNode take_root() { return std::move(root_); }

    void OnDocumentStart(const YAML::Mark& mark) override {
        if (++document_count_ > 1) {
            throw Error(source_.place_of(mark), "a second document starts here; expected one document");
        }
    }
    void OnDocumentEnd() override {}

    void OnNull(const YAML::Mark& mark, YAML::anchor_t) override { add(node(YamlNode::Kind::nothing, mark)); }
    void OnAnchor(const YAML::Mark& mark, const std::string& name) override {
        throw Error(source_.place_of(mark),
                    fmt::format("anchors (&{}) are not supported; share values with \"include\"", name));
    }
    void OnAlias(const YAML::Mark& mark, YAML::anchor_t) override {
        throw Error(source_.place_of(mark), "aliases (*) are not supported; share values with \"include\"");
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
    /// A list or map that has begun and not ended.
    struct Open {
        YamlNode node;
        std::optional<YamlNode> key; ///< map: waits for its value
        std::unordered_set<std::string> keys;
    };

    YamlNode node(YamlNode::Kind kind, const YAML::Mark& mark) {
        YamlNode made;
        made.kind = kind;
        made.place = source_.place_of(mark);
        if (++node_count_ > YamlLimits::nodes) {
            throw Error(made.place, fmt::format("more than {} values, expected a chain", YamlLimits::nodes));
        }
        return made;
    }

    /// yaml-cpp gives "?" for a plain node without a tag and "!" for quoted text.
    void refuse_tag(const YAML::Mark& mark, const std::string& tag) const {
        if (tag.empty() || tag == "?" || tag == "!") return;
        throw Error(source_.place_of(mark), fmt::format("tags ({}) are not supported", quote(tag)));
    }

    void open(YamlNode::Kind kind, const YAML::Mark& mark, const std::string& tag) {
        refuse_tag(mark, tag);
        if (open_.size() == YamlLimits::depth) {
            throw Error(source_.place_of(mark), fmt::format("nested more than {} deep", YamlLimits::depth));
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
            if (added.is(YamlNode::Kind::nothing)) added.place = parent.key->place;
            parent.node.members.push_back({std::move(*parent.key), std::move(added)});
            parent.key.reset();
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

    const Source& source_;
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
    constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
    if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
    if (text.size() > YamlLimits::bytes) {
        throw Error(Place{.file = origin},
                    fmt::format("is larger than {} KiB, expected a chain", YamlLimits::bytes / 1024));
    }
    const Source source(text, origin);
    source.check_characters();

    TreeBuilder builder(source);
    try {
        std::istringstream stream{std::string(text)};
        YAML::Parser parser(stream);
        while (parser.HandleNextDocument(builder)) {
        }
    } catch (const YAML::Exception& error) {
        const bool tab = source.has_tab_in_indentation(error.mark);
        throw Error(source.place_of(error.mark), fmt::format("this is not YAML: {}{}", error.msg,
                                                             tab ? "; indent with spaces, not tabs" : ""));
    }
    return builder.take_root();
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
