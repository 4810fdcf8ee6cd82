#include "gltf_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace postfx::host {
namespace {

using Json = GltfDocument::Json;
using Target = AnimationClip::Target;

std::optional<Target> target_of(const std::string& path) {
    if (path == "translation") return Target::translation;
    if (path == "rotation") return Target::rotation;
    if (path == "scale") return Target::scale;
    if (path == "weights") return Target::shape_weights;
    return std::nullopt;
}

std::size_t width_of(Target target, const Node& node) {
    if (target == Target::shape_weights) return node.shape_weights.size();
    return target == Target::rotation ? 4 : 3;
}

bool are_finite(const std::vector<float>& values) {
    return std::all_of(values.begin(), values.end(), [](float value) { return std::isfinite(value); });
}

Track read_track(const GltfDocument& document, const Json& sampler, std::size_t width) {
    Track track;
    track.width = static_cast<std::uint32_t>(width);
    const std::string interpolation = sampler.value("interpolation", "LINEAR");
    if (interpolation == "STEP") track.interpolation = Track::Interpolation::step;
    if (interpolation == "CUBICSPLINE") track.interpolation = Track::Interpolation::cubic;
    track.times = read_numbers(document, document.index(sampler, "input"), 1);
    const std::size_t output = document.index(sampler, "output");
    track.values = read_numbers(document, output, accessor_width(document, output));
    const std::size_t per_key = width * (track.interpolation == Track::Interpolation::cubic ? 3 : 1);
    if (track.times.empty() || track.values.size() != per_key * track.times.size()) {
        document.fail(fmt::format("an animation has {} keys and {} numbers, expected {} to a key",
                                  track.times.size(), track.values.size(), per_key));
    }
    if (!are_finite(track.times) || !are_finite(track.values))
        document.fail("an animation has keys that are not finite");
    if (std::adjacent_find(track.times.begin(), track.times.end(), std::greater_equal<>())
        != track.times.end())
        document.fail("the keys of an animation are not in the order of their times");
    return track;
}

AnimationClip read_clip(const GltfDocument& document, const Json& animation,
                        const std::vector<std::size_t>& node_of_gltf, const std::vector<Node>& nodes) {
    AnimationClip clip{animation.value("name", ""), {}};
    const Json& samplers = animation.at("samplers");
    for (const Json& channel : animation.at("channels")) {
        const Json& aim = channel.at("target");
        const auto target = target_of(aim.value("path", ""));
        const auto node = document.find_index(aim, "node");
        if (!node || !target) continue; // glTF: to be ignored
        document.item("nodes", *node);
        const std::size_t index = node_of_gltf[*node], sampler = document.index(channel, "sampler");
        if (sampler >= samplers.size())
            document.fail(fmt::format("an animation has no samplers[{}]", sampler));
        const std::size_t width = width_of(*target, nodes[index]);
        if (width > 0)
            clip.channels.push_back({index, *target, read_track(document, samplers[sampler], width)});
    }
    return clip;
}

} // namespace

std::vector<AnimationClip> read_gltf_animations(const GltfDocument& document,
                                                const std::vector<std::size_t>& node_of_gltf,
                                                const std::vector<Node>& nodes) {
    std::vector<AnimationClip> clips;
    for (std::size_t i = 0; i < document.count("animations"); ++i)
        clips.push_back(read_clip(document, document.item("animations", i), node_of_gltf, nodes));
    return clips;
}

} // namespace postfx::host
