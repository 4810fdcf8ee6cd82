#include <image/exr_layers.hpp>

#include <algorithm>
#include <cctype>
#include <set>

namespace postfx::formats {
namespace {

std::string prefix_of(const std::string& name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? "" : name.substr(0, dot);
}

/// What follows the last dot.
std::string component_of(const std::string& name) {
    const std::size_t dot = name.rfind('.');
    return dot == std::string::npos ? name : name.substr(dot + 1);
}

std::string joined(const std::string& prefix, const std::string& component) {
    return prefix.empty() ? component : prefix + "." + component;
}

/// Take `components` out of `rest` where they are there; is any?
bool take(std::set<std::string>& rest, const std::vector<std::string>& components) {
    bool any = false;
    for (const std::string& component : components)
        any = rest.erase(component) > 0 || any;
    return any;
}

/// The components that share one prefix.
void group_components(const std::string& prefix, std::set<std::string> rest, Layers& layers) {
    std::vector<std::string> first;
    if (take(rest, {"R", "G", "B"}))
        first = {"R", "G", "B"};
    else if (prefix.empty() && take(rest, {"Y"}))
        first = {"Y"};
    if (!first.empty() && take(rest, {"A"})) first.emplace_back("A");
    if (first.empty() && !prefix.empty()) {
        first.assign(rest.begin(), rest.end());
        rest.clear();
    }
    if (!first.empty()) {
        std::vector<std::string>& channels = layers[prefix];
        for (const std::string& component : first)
            channels.push_back(joined(prefix, component));
    }
    for (const std::string& component : rest)
        layers[joined(prefix, component)] = {joined(prefix, component)};
}

bool is_color(const Layers::value_type& layer) {
    return layer.second.size() >= 3 && component_of(layer.second[0]) == "R";
}

} // namespace

Layers group_channels(const std::vector<std::string>& names) {
    std::map<std::string, std::set<std::string>> by_prefix;
    for (const std::string& name : names)
        by_prefix[prefix_of(name)].insert(component_of(name));
    Layers layers;
    if (names.size() == 1) {
        layers[names[0]] = {names[0]};
        return layers;
    }
    for (const auto& [prefix, components] : by_prefix)
        group_components(prefix, components, layers);
    return layers;
}

const Layers::value_type* main_layer(const Layers& layers, const std::vector<std::string>& views) {
    if (layers.size() == 1 && layers.begin()->second.size() == 1) return &*layers.begin();
    if (const auto found = layers.find(""); found != layers.end()) return &*found;
    for (const std::string& view : views) {
        const auto found = layers.find(view);
        if (found != layers.end() && is_color(*found)) return &*found;
    }
    const auto found = std::find_if(layers.begin(), layers.end(), is_color);
    return found == layers.end() ? nullptr : &*found;
}

const Layers::value_type* depth_layer(const Layers& layers) {
    const Layers::value_type* best = nullptr;
    const auto dots = [](const std::string& name) { return std::count(name.begin(), name.end(), '.'); };
    for (const auto& layer : layers) {
        std::string word = component_of(layer.first);
        std::transform(word.begin(), word.end(), word.begin(),
                       [](unsigned char letter) { return static_cast<char>(std::tolower(letter)); });
        if (layer.second.size() != 1 || (word != "z" && word != "depth")) continue;
        if (!best || dots(layer.first) < dots(best->first)) best = &layer;
    }
    return best;
}

} // namespace postfx::formats
