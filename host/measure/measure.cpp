#include "measure.hpp"

#include <gl/full_screen.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace postfx::host {
namespace {

constexpr const char* copy_shader =
    "#version 450 core\n"
    "layout(binding = 0) uniform sampler2D u_color;\n"
    "layout(location = 0) out vec4 o_color;\n"
    "void main() { o_color = texelFetch(u_color, ivec2(gl_FragCoord.xy), 0); }\n";

gl::Query make_query() {
    GLuint name = 0;
    glCreateQueries(GL_TIME_ELAPSED, 1, &name);
    return gl::Query(name);
}

void draw_timed(Case& drawn, const gl::Query& query, bool counts) {
    glFinish();
    const gl::HostTime start = gl::HostTime::now();
    glBeginQuery(GL_TIME_ELAPSED, query.name());
    drawn.draw();
    glEndQuery(GL_TIME_ELAPSED);
    glFinish();
    const gl::HostTime end = gl::HostTime::now();
    if (!counts) return;
    GLuint64 elapsed_ns = 0;
    glGetQueryObjectui64v(query.name(), GL_QUERY_RESULT, &elapsed_ns);
    drawn.cpu_ms.push_back(end.cpu_ms - start.cpu_ms);
    drawn.wall_ms.push_back(end.wall_ms - start.wall_ms);
    drawn.gpu_ms.push_back(static_cast<double>(elapsed_ns) * 1e-6);
}

/// What makes a difference to a renderer of one sample per pixel.
std::vector<std::string> key_of(const std::vector<std::string>& attachments) {
    std::vector<std::string> key = {"color"};
    for (const std::string& name : attachments) {
        if (name != "color" && name != "depth") key.push_back(name);
    }
    std::sort(key.begin(), key.end());
    return key;
}

} // namespace

PlainPass::PlainPass(int width, int height, Format format, const std::string& fragment,
                     const std::string& name)
    : target_(width, height, format), framebuffer_(gl::make_framebuffer({target_.name()})),
      program_(gl::make_program(gl::full_screen_vertex_text, fragment, name, {name})),
      vertex_array_(gl::make_vertex_array()), nearest_(gl::make_sampler(false)),
      linear_(gl::make_sampler(true)) {}

PlainPass PlainPass::copy(int width, int height, Format format) {
    return {width, height, format, copy_shader, "copy pass"};
}

void PlainPass::draw(std::uint32_t color) const {
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
    glViewport(0, 0, target_.width(), target_.height());
    glUseProgram(program_.name());
    glBindVertexArray(vertex_array_.name());
    glBindTextureUnit(0, color);
    glBindSampler(0, nearest_.name());
    glBindTextureUnit(1, color);
    glBindSampler(1, linear_.name());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindSampler(0, 0);
    glBindSampler(1, 0);
}

Image PlainPass::picture() const {
    return gl::read_texture(target_.name(), target_.width(), target_.height(), target_.format());
}

void measure(std::vector<Case>& cases, int rounds, ProgressBar& progress,
             const std::function<void()>& after_round, int warm_up) {
    std::mt19937 random(1);
    std::vector<std::size_t> order(cases.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const gl::Query query = make_query();
    for (int round = -warm_up; round < rounds; ++round) {
        std::shuffle(order.begin(), order.end(), random);
        for (std::size_t i : order)
            draw_timed(cases[i], query, round >= 0);
        if (after_round && round >= 0) after_round();
        progress.advance();
    }
}

double quantile(std::vector<double> samples, double share) {
    if (samples.empty()) return 0;
    const auto at =
        samples.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(samples.size() - 1));
    std::nth_element(samples.begin(), at, samples.end());
    return *at;
}

double median(const std::vector<double>& samples) {
    return quantile(samples, 0.5);
}

std::string mebibytes_text(std::int64_t bytes) {
    const double tenths = std::round(static_cast<double>(bytes) * 10 / (1024 * 1024));
    return fmt::format("{:.1f}", tenths == 0 ? 0.0 : tenths / 10);
}

std::vector<double> differences(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> result(a.size());
    std::transform(b.begin(), b.end(), a.begin(), result.begin(), std::minus<>());
    return result;
}

SceneRenderers::SceneRenderers(Scene scene, int width, int height, double time)
    : scene_(std::move(scene)), width_(width), height_(height), time_(time) {}

const SceneFrame& SceneRenderers::draw(const std::vector<std::string>& attachments) {
    const std::vector<std::string> key = key_of(attachments);
    auto found = drawn_.find(key);
    if (found == drawn_.end()) found = drawn_.emplace(key, Drawn{SceneRenderer(scene_), {}}).first;
    Drawn& drawn = found->second;
    drawn.frame = drawn.renderer.render(width_, height_, time_, key);
    return drawn.frame;
}

bool SceneRenderers::same(const std::vector<std::string>& a, const std::vector<std::string>& b) {
    return key_of(a) == key_of(b);
}

} // namespace postfx::host
