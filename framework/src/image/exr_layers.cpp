#include <image/exr_layers.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <iterator>

namespace postfx::formats {
namespace {

using Shape = ExrLayer::Shape;

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
    return text;
}

std::string joined(const std::string& prefix, const std::string& component) {
    return prefix.empty() ? component : prefix + "." + component;
}

/// "R" of "R", "r", "red" (as Nuke and V-Ray write it); what is none of the usual components stays itself.
std::string component_of(const std::string& channel) {
    static const std::map<std::string, std::string> usual = {
        {"r", "R"},     {"red", "R"}, {"g", "G"}, {"green", "G"}, {"b", "B"},   {"blue", "B"}, {"a", "A"},
        {"alpha", "A"}, {"x", "X"},   {"y", "Y"}, {"z", "Z"},     {"ry", "RY"}, {"by", "BY"}};
    const std::string component = after_last_dot(channel);
    const auto found = usual.find(lower(component));
    return found == usual.end() ? component : found->second;
}

/// Channels of one part with one prefix.
struct Group {
    int part = 0;
    std::string name, path, view;
    std::map<std::string, ExrChannel> rest; ///< by component; what no layer has taken yet

    bool has(const std::string& component) const { return rest.contains(component); }
    int count(const std::vector<std::string>& components) const {
        return static_cast<int>(std::count_if(components.begin(), components.end(),
                                              [&](const std::string& name) { return has(name); }));
    }
};

class LayerMaker {
public:
    LayerMaker(Group group, std::vector<ExrLayer>& layers) : group_(std::move(group)), layers_(layers) {}

    void make() {
        const bool main = make_main();
        if (group_.count({"X", "Y", "Z"}) == 3 && (main || !group_.has("w")))
            add(main ? joined(group_.name, "X,Y,Z") : group_.name, Shape::vector, {"X", "Y", "Z"});
        else if (!make_vectors() && !main && !group_.name.empty() && belongs_together())
            add(group_.name, group_.rest.size() == 1 ? Shape::single : Shape::other, components());
        for (const std::string& component : components()) {
            const std::string name = after_last_dot(group_.rest.at(component).name);
            add(joined(group_.name, name), Shape::single, {component});
        }
    }

private:
    /// The picture among the channels, if there is one.
    bool make_main() {
        const int colors = group_.count({"R", "G", "B"});
        const bool alpha = group_.has("A");
        if (colors >= 2 || (colors == 1 && alpha)) {
            add(group_.name, Shape::color, with_alpha({"R", "G", "B"}));
            return true;
        }
        if (colors > 0 || !group_.has("Y") || group_.has("X")) return false;
        if (group_.has("RY") && group_.has("BY")) {
            add(group_.name, Shape::luminance_chroma, with_alpha({"Y", "RY", "BY"}));
            return true;
        }
        if (!group_.name.empty() && !alpha) return false;
        add(group_.name, Shape::grey, with_alpha({"Y"}));
        return true;
    }

    /// Vectors whose components are channels of names of their own: "Nx", "Ny" and "Nz". Not "Px" and so on, of which "Pz"
    /// is a depth by itself.
    bool make_vectors() {
        bool any = false;
        for (const std::string& x : components()) {
            std::string stem = x.substr(0, x.size() - 1);
            if (stem.empty() || lower(stem) == "p" || lower(x).back() != 'x') continue;
            const auto sibling = [&](int steps) { return stem + static_cast<char>(x.back() + steps); };
            const std::string y = sibling(1), z = sibling(2);
            if (!has_all({y, z})) continue;
            while (stem.size() > 1 && (stem.back() == '_' || stem.back() == '-'))
                stem.pop_back();
            add(joined(group_.name, stem), Shape::vector, {x, y, z});
            any = true;
        }
        return any;
    }

    bool has_all(const std::vector<std::string>& components) const {
        return group_.count(components) == static_cast<int>(components.size());
    }

    /// A depth beside something else (depth.Z and depth.Zback) is a layer of its own.
    bool belongs_together() const {
        return !group_.rest.empty() && (group_.rest.size() == 1 || !group_.has("Z") || group_.has("Y"));
    }

    std::vector<std::string> components() const {
        std::vector<std::string> names;
        for (const auto& [component, channel] : group_.rest)
            names.push_back(component);
        return names;
    }

    std::vector<std::string> with_alpha(std::vector<std::string> names) const {
        if (group_.has("A")) names.emplace_back("A");
        return names;
    }

    void add(const std::string& name, Shape shape, const std::vector<std::string>& wanted) {
        ExrLayer layer{
            .name = name, .path = group_.path, .view = group_.view, .part = group_.part, .shape = shape};
        if (name != group_.name) layer.path = joined(group_.path, after_last_dot(name));
        for (const std::string& component : wanted) {
            const auto found = group_.rest.find(component);
            if (found == group_.rest.end()) {
                layer.channels.push_back(joined(group_.path, component));
                continue;
            }
            layer.channels.push_back(found->second.name);
            layer.has_light = layer.has_light && found->second.type != "uint";
            group_.rest.erase(found);
        }
        const bool picture =
            shape == Shape::color || shape == Shape::grey || shape == Shape::luminance_chroma;
        layer.has_alpha = picture && wanted.back() == "A";
        layers_.push_back(std::move(layer));
    }

    Group group_;
    std::vector<ExrLayer>& layers_;
};

/// The views that the file names; without a word of it, eyes by the names that OpenEXR reserves for them.
std::vector<std::string> views_of(const std::vector<ExrPart>& parts,
                                  const std::vector<std::string>& multi_view) {
    std::vector<std::string> views = multi_view;
    const auto add = [&](const std::string& view) {
        if (!view.empty() && !std::count(views.begin(), views.end(), view)) views.push_back(view);
    };
    for (const ExrPart& part : parts)
        add(part.view);
    if (!views.empty()) return views;
    for (const ExrPart& part : parts)
        for (const ExrChannel& channel : part.channels)
            for (const char* eye : {"left", "right"})
                if (after_last_dot(before_last_dot(channel.name)) == eye) add(eye);
    return views;
}

/// A name without its view, which stands before the channel: "ViewLayer.Combined.left", "left.Z", "rgba.left".
std::string without_view(const std::string& path, const std::string& view) {
    if (view.empty()) return path;
    if (after_last_dot(path) == view) return before_last_dot(path);
    return path;
}

class Grouping {
public:
    Grouping(const std::vector<ExrPart>& parts, const std::vector<std::string>& multi_view)
        : parts_(parts), views_(views_of(parts, multi_view)), multi_view_(multi_view) {}

    std::vector<Group> groups() {
        for (int part = 0; part < static_cast<int>(parts_.size()); ++part)
            for (const ExrChannel& channel : parts_[static_cast<std::size_t>(part)].channels)
                add(part, channel);
        name_apart();
        return std::move(groups_);
    }
    const std::vector<std::string>& views() const { return views_; }

private:
    void add(int part, const ExrChannel& channel) {
        const std::string path = before_last_dot(channel.name);
        Group& group = group_for(part, path);
        const std::string component = component_of(channel.name);
        // Two spellings of one component ("R" and "red") are two channels.
        group.rest.emplace(group.has(component) ? after_last_dot(channel.name) : component, channel);
    }

    Group& group_for(int index, const std::string& path) {
        const ExrPart& part = parts_[static_cast<std::size_t>(index)];
        const auto found = std::find_if(groups_.begin(), groups_.end(), [&](const Group& group) {
            return group.part == index && group.path == path;
        });
        if (found != groups_.end()) return *found;
        Group group{.part = index, .name = {}, .path = path, .view = view_for(part, path), .rest = {}};
        group.name = without_view(path, group.view);
        // In a file of parts, the part's name is the layer's where the channels have none.
        if (group.name.empty() && parts_.size() > 1) group.name = without_view(part.name, group.view);
        groups_.push_back(std::move(group));
        return groups_.back();
    }

    std::string view_for(const ExrPart& part, const std::string& path) const {
        if (!part.view.empty()) return part.view;
        std::string last = after_last_dot(path);
        if (std::count(views_.begin(), views_.end(), last)) return last;
        // Channels without a prefix are the default view's (OpenEXR, "Multi-View OpenEXRs").
        return path.empty() && !multi_view_.empty() ? multi_view_.front() : "";
    }

    /// Parts that hold a layer of the same name are told apart by their own names, all layers of theirs.
    void name_apart() {
        std::map<std::pair<std::string, std::string>, std::set<int>> parts_with;
        for (const Group& group : groups_)
            parts_with[{group.name, group.view}].insert(group.part);
        std::set<int> alike;
        for (const auto& [name, parts] : parts_with)
            if (parts.size() > 1) alike.insert(parts.begin(), parts.end());
        for (Group& group : groups_)
            if (alike.contains(group.part)) prefix_with_part(group);
    }

    void prefix_with_part(Group& group) const {
        const ExrPart& part = parts_[static_cast<std::size_t>(group.part)];
        const std::string own =
            part.name.empty() ? fmt::format("part{}", group.part + 1) : without_view(part.name, group.view);
        if (group.name != own && !group.name.starts_with(own + ".")) group.name = joined(own, group.name);
    }

    const std::vector<ExrPart>& parts_;
    std::vector<std::string> views_;
    const std::vector<std::string>& multi_view_;
    std::vector<Group> groups_;
};

bool is_picture(const ExrLayer& layer) {
    return layer.shape == Shape::color || layer.shape == Shape::grey
           || layer.shape == Shape::luminance_chroma;
}

/// The first one that the file names; else what belongs to none, if that is a picture; else the left eye, as
/// compositors have it; else the first.
std::string default_view_of(const ExrContents& contents, const std::vector<std::string>& multi_view) {
    if (!multi_view.empty()) return multi_view.front();
    const bool picture_without =
        std::any_of(contents.layers.begin(), contents.layers.end(),
                    [](const ExrLayer& layer) { return layer.view.empty() && is_picture(layer); });
    if (contents.views.empty() || picture_without) return "";
    const bool left = std::count(contents.views.begin(), contents.views.end(), "left") > 0;
    return left ? "left" : contents.views.front();
}

/// Cryptomatte's layers are called by its attribute and two digits; without attributes by the word itself.
bool is_matte(const ExrLayer& layer, const std::set<std::string>& mattes) {
    if (lower(layer.path).find("crypto") != std::string::npos) return true;
    return std::any_of(mattes.begin(), mattes.end(), [&](const std::string& matte) {
        return layer.path.starts_with(matte) || layer.pass().starts_with(matte);
    });
}

} // namespace

std::string after_last_dot(const std::string& name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? name : name.substr(dot + 1);
}

std::string before_last_dot(const std::string& name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? "" : name.substr(0, dot);
}

std::string ExrLayer::label() const {
    if (!name.empty()) return name;
    std::vector<std::string> components;
    for (const std::string& channel : channels)
        components.push_back(after_last_dot(channel));
    return fmt::format("{}", fmt::join(components, ","));
}

std::string ExrLayer::family() const {
    return before_last_dot(name);
}

std::string ExrLayer::pass() const {
    return after_last_dot(name);
}

bool ExrContents::is_in_view(const ExrLayer& layer, const std::string& view) const {
    return layer.view == view || (layer.view.empty() && view == default_view);
}

ExrContents contents_of(const std::vector<ExrPart>& parts, const std::vector<std::string>& multi_view,
                        const std::set<std::string>& mattes) {
    Grouping grouping(parts, multi_view);
    ExrContents contents{.views = grouping.views(), .default_view = {}, .layers = {}};
    for (Group& group : grouping.groups())
        LayerMaker(std::move(group), contents.layers).make();
    for (ExrLayer& layer : contents.layers)
        if (is_matte(layer, mattes)) layer.has_light = false;
    contents.default_view = default_view_of(contents, multi_view);
    return contents;
}

} // namespace postfx::formats
