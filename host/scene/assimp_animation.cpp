#include "assimp_parts.hpp"

#include <algorithm>
#include <cmath>

namespace postfx::host {
namespace {

using Target = AnimationClip::Target;

/// `numbers(key)` gives a key's values. Keys that are not later than the one before are left out.
template<class Key, class Numbers>
void add_channel(AnimationClip& clip, std::size_t node, Target target, const Key* keys, unsigned count,
                 double per_second, Numbers numbers) {
    Track track;
    for (unsigned i = 0; i < count; ++i) {
        const auto time = static_cast<float>(keys[i].mTime / per_second);
        const std::vector<float> values = numbers(keys[i]);
        const bool finite = std::isfinite(time) && std::all_of(values.begin(), values.end(), [](float v) {
                                return std::isfinite(v);
                            });
        if (!finite || (!track.times.empty() && time <= track.times.back())) continue;
        track.width = static_cast<std::uint32_t>(values.size());
        track.times.push_back(time);
        track.values.insert(track.values.end(), values.begin(), values.end());
    }
    if (!track.times.empty() && track.width > 0) clip.channels.push_back({node, target, std::move(track)});
}

std::vector<float> vector_key(const aiVectorKey& key) {
    return {key.mValue.x, key.mValue.y, key.mValue.z};
}

} // namespace

AnimationClip read_assimp_animation(const aiAnimation& source,
                                    const std::map<std::string, std::size_t>& node_by_name,
                                    const std::vector<Node>& nodes) {
    constexpr double usual_ticks = 25; // per second, where a file does not say
    const double per_second = source.mTicksPerSecond > 0 ? source.mTicksPerSecond : usual_ticks;
    AnimationClip clip{source.mName.C_Str(), {}};
    for (unsigned i = 0; i < source.mNumChannels; ++i) {
        const aiNodeAnim& channel = *source.mChannels[i];
        const auto node = node_by_name.find(channel.mNodeName.C_Str());
        if (node == node_by_name.end()) continue;
        add_channel(clip, node->second, Target::translation, channel.mPositionKeys, channel.mNumPositionKeys,
                    per_second, vector_key);
        add_channel(clip, node->second, Target::rotation, channel.mRotationKeys, channel.mNumRotationKeys,
                    per_second, [](const aiQuatKey& key) {
                        return std::vector<float>{key.mValue.x, key.mValue.y, key.mValue.z, key.mValue.w};
                    });
        add_channel(clip, node->second, Target::scale, channel.mScalingKeys, channel.mNumScalingKeys,
                    per_second, vector_key);
    }
    for (unsigned i = 0; i < source.mNumMorphMeshChannels; ++i) {
        const aiMeshMorphAnim& channel = *source.mMorphMeshChannels[i];
        const std::string name = channel.mName.C_Str();
        const std::string plain = name.substr(0, name.find('*')); // FBX: the mesh's number follows
        for (std::size_t node = 0; node < nodes.size(); ++node) {
            const std::size_t shapes = nodes[node].shape_weights.size();
            if (shapes == 0 || nodes[node].name != plain) continue;
            add_channel(clip, node, Target::shape_weights, channel.mKeys, channel.mNumKeys, per_second,
                        [shapes](const aiMeshMorphKey& key) {
                            std::vector<float> weights(shapes, 0.0f);
                            for (unsigned k = 0; k < key.mNumValuesAndWeights; ++k) {
                                if (key.mValues[k] < shapes)
                                    weights[key.mValues[k]] = static_cast<float>(key.mWeights[k]);
                            }
                            return weights;
                        });
        }
    }
    return clip;
}

} // namespace postfx::host
