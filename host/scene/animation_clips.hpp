// Animations of a model file on their way into its nodes.
#pragma once

#include "losses.hpp"
#include "scene.hpp"

#include <string>
#include <vector>

namespace postfx::host {

struct AnimationClip {
    enum class Target : std::uint8_t { translation, rotation, scale, shape_weights };
    struct Channel {
        std::size_t node;
        Target target;
        Track track;
    };
    std::string name;
    std::vector<Channel> channels;
};

/// Put key frames into nodes, which lie as `at_rest` says where nothing moves them. All clips that don't move the same
/// things are played together; the others are a loss.
void play_clips(std::vector<AnimationClip> clips, const std::vector<NodeKeys>& at_rest,
                std::vector<Node>& nodes, Losses& losses);

} // namespace postfx::host
