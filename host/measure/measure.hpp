// What things cost, measured in turns in one run: whatever else the machine does meanwhile meets all of them.
// [GL thread]
#pragma once

#include "scene/renderer.hpp"
#include "terminal/progress_bar.hpp"

#include <gl/clock.hpp>
#include <gl/objects.hpp>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace postfx::host {

/// Something to measure, with its samples: one per round.
struct Case {
    std::string name;
    std::function<void()> draw;
    std::size_t texture_bytes = 0; ///< of what it draws into, if that is known
    std::vector<double> cpu_ms = {}, wall_ms = {}, gpu_ms = {};

    /// Of the GPU's clock if that is to be believed and was asked, else CPU time of all threads.
    const std::vector<double>& times(bool gpu) const { return gpu && !gpu_ms.empty() ? gpu_ms : cpu_ms; }
};

/// A full-screen pass with a fragment shader of its own: the unit of account, and hand-written rivals.
/// The shader samples `u_color` at binding 0 (nearest) or `u_color_linear` at binding 1.
class PlainPass {
public:
    PlainPass(int width, int height, Format format, const std::string& fragment, const std::string& name);
    /// The unit of account: every pixel read once and written once.
    static PlainPass copy(int width, int height, Format format);

    void draw(std::uint32_t color) const;
    Image picture() const;

private:
    gl::Texture target_;
    gl::Framebuffer framebuffer_;
    gl::Program program_;
    gl::VertexArray vertex_array_;
    gl::Sampler nearest_, linear_;
};

/// Rounds before those that count.
inline constexpr int warm_up_rounds = 3;

/// Draw every case once per round, in another order each time. `after_round` is called behind each that counts.
/// `progress` advances `rounds` + `warm_up` times.
void measure(std::vector<Case>& cases, int rounds, ProgressBar& progress,
             const std::function<void()>& after_round = {}, int warm_up = warm_up_rounds);

/// 0 without samples.
double quantile(std::vector<double> samples, double share);
double median(const std::vector<double>& samples);

/// "12.3": of 2^20 bytes; never "-0.0".
std::string mebibytes_text(std::int64_t bytes);

/// b - a of each round.
std::vector<double> differences(const std::vector<double>& a, const std::vector<double>& b);

/// Renders a scene for several chains in turns: a renderer for each set of attachments, so that none pays for what
/// another reads. One sample per pixel.
class SceneRenderers {
public:
    SceneRenderers(Scene scene, int width, int height, double time);

    /// Draw the scene with these attachments (color and depth are always there). The frame is overwritten by the
    /// next with the same ones.
    const SceneFrame& draw(const std::vector<std::string>& attachments);
    /// Is it the same drawing for both?
    static bool same(const std::vector<std::string>& a, const std::vector<std::string>& b);

private:
    struct Drawn {
        SceneRenderer renderer;
        SceneFrame frame;
    };

    Scene scene_;
    int width_, height_;
    double time_;
    std::map<std::vector<std::string>, Drawn> drawn_;
};

} // namespace postfx::host
