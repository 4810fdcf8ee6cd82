// What an effect ought to give, found by means that share nothing with the effect: no shader, no formula in common
// but the model that its page states. Slow, in float64, and honest about its own error.
#pragma once

#include <scene/scene.hpp>

#include <postfx/chain.hpp>
#include <postfx/image.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace postfx::host {

/// The picture that is asked for.
struct TruthRequest {
    Scene scene;
    double time = 0; ///< seconds after the scene's start
    int width = 0, height = 0;
    int scene_samples =
        4; ///< per pixel of a drawn scene, 1 or 4: as in the pictures that are compared with the truth
    ChainEntry entry;        ///< the effect with its values; its level does not matter
    std::uint32_t frame = 0; ///< as in FrameInputs; for what changes from frame to frame
    /// The picture that the effect is given, 3 channels of that size; null: the scene as it is drawn.
    std::shared_ptr<const Image64> given = nullptr;

    /// One of the entry's values. Throws Error when the effect has no such parameter.
    double value(std::string_view parameter) const;
    /// All three channels of one.
    std::array<double, 3> color(std::string_view parameter) const;
    /// All of the entry's values, as text.
    std::string all_values() const;
};

/// A mean over samples, each of which says something of every pixel. Even and odd samples are two sequences of their
/// own: how far their means are apart is what the truth knows of its own error. Needs a current OpenGL 4.5 context.
class Truth {
public:
    /// Of a picture that is given? False for what draws the scene in its own way.
    static constexpr bool takes_given = true;

    virtual ~Truth() = default;

    /// What it is, in one line: "1024 lens positions, off-axis frusta, ...".
    virtual std::string description(int samples) const = 0;
    /// Everything besides the scene, its time and the size that the sum depends on, as text.
    virtual std::string values() const = 0;
    /// Of a sum.
    virtual int channels() const = 0;
    /// Add sample `index` to a sum of the picture's size. The same index always adds the same.
    virtual void add(int index, Image64& sum) = 0;
    /// The picture, 3 channels, scene-linear, that a sum of `count` samples tells. count > 0.
    virtual Image64 picture(const Image64& sum, int count) const = 0;
};

/// What a sum of `count` samples is on average; count > 0.
Image64 mean_of(Image64 sum, int count);

struct RegisteredTruth {
    std::string effect; ///< id
    /// "scene": of the phenomenon itself, from the scene. "layer": the best that can be had from what the effect is
    /// given.
    std::string kind;
    std::string help;
    int samples; ///< unless told otherwise
    /// What a picture has in common with it: every pixel, or only its statistics (noise of another making).
    enum class Compared { pixels, statistics } compared;
    bool takes_given; ///< see Truth
    std::unique_ptr<Truth> (*make)(const TruthRequest& request);
};

/// All of them, in no order.
std::vector<RegisteredTruth>& registered_truths();

/// Throws Error, which names those that there are.
const RegisteredTruth& find_truth(const std::string& effect, const std::string& kind);

/// `static const RegisterTruth<T> registered("effect", "scene", "help", 1024);` at the end of the truth's file. T is
/// made from a request and throws Error when there is no truth of it.
template<class T>
struct RegisterTruth {
    using Compared = RegisteredTruth::Compared;
    RegisterTruth(std::string effect, std::string kind, std::string help, int samples,
                  Compared compared = Compared::pixels) {
        registered_truths().push_back({std::move(effect), std::move(kind), std::move(help), samples, compared,
                                       T::takes_given,
                                       [](const TruthRequest& request) -> std::unique_ptr<Truth> {
                                           return std::make_unique<T>(request);
                                       }});
    }
};

} // namespace postfx::host
