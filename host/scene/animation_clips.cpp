#include "animation_clips.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace postfx::host {
namespace {

std::optional<Track>& track_of(NodeKeys& keys, AnimationClip::Target target) {
    switch (target) {
    case AnimationClip::Target::translation:
        return keys.translations;
    case AnimationClip::Target::rotation:
        return keys.rotations;
    case AnimationClip::Target::scale:
        return keys.scales;
    case AnimationClip::Target::shape_weights:
        break;
    }
    return keys.shape_weights;
}

double duration_of(const AnimationClip& clip) {
    double duration = 0;
    for (const AnimationClip::Channel& channel : clip.channels)
        duration = std::max(duration, static_cast<double>(channel.track.times.back()));
    return duration;
}

} // namespace

void play_clips(std::vector<AnimationClip> clips, const std::vector<NodeKeys>& at_rest,
                std::vector<Node>& nodes, Losses& losses) {
    static const LossKind kind{"animation is left out, for another moves the same nodes",
                               "animations are left out, for others move the same nodes"};
    std::map<std::size_t, NodeKeys> keys;
    std::set<std::pair<std::size_t, AnimationClip::Target>> moved;
    for (AnimationClip& clip : clips) {
        const bool clashes =
            std::any_of(clip.channels.begin(), clip.channels.end(), [&](const auto& channel) {
                return moved.contains({channel.node, channel.target});
            });
        if (clashes) {
            losses.add(kind, clip.name);
            continue;
        }
        const double duration = duration_of(clip);
        for (AnimationClip::Channel& channel : clip.channels) {
            moved.emplace(channel.node, channel.target);
            NodeKeys& of_node = keys.try_emplace(channel.node, at_rest[channel.node]).first->second;
            of_node.duration = std::max(of_node.duration, duration);
            track_of(of_node, channel.target) = std::move(channel.track);
        }
    }
    for (auto& [node, of_node] : keys)
        nodes[node].keys = std::make_shared<const NodeKeys>(std::move(of_node));
}

} // namespace postfx::host
