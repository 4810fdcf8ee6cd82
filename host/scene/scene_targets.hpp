// What a scene is drawn into, and the textures that come out. [GL thread]
#pragma once

#include "shader_library.hpp"

#include <gl/objects.hpp>

#include <vector>

namespace postfx::host {

class SceneTargets {
public:
    /// `samples` 1 or 4 per pixel. `resolve_depth`: of several samples, bring depth into its texture too; outputs with
    /// normals need it.
    SceneTargets(int width, int height, OutputNames outputs, int samples, bool resolve_depth);

    /// Clear and make it the current framebuffer.
    void begin() const;
    /// Bring the picture into the textures, if it is not there already.
    void resolve(GLuint empty_vertex_array) const;

    int width() const { return colors_.front().width(); }
    int height() const { return colors_.front().height(); }
    const OutputNames& outputs() const { return outputs_; }
    bool resolves_depth() const { return resolve_depth_; }
    std::size_t bytes() const;
    GLuint output(std::size_t index) const { return colors_[index].name(); }
    GLuint depth() const { return depth_.name(); }

private:
    using TextureHandle = gl::Handle<gl::destroy_texture>;

    OutputNames outputs_;
    int samples_;
    bool resolve_depth_;
    std::vector<gl::Texture> colors_;
    gl::Texture depth_;           ///< empty where depth stays in the samples
    gl::Framebuffer framebuffer_; ///< over the textures
    std::vector<TextureHandle> sample_colors_;
    TextureHandle sample_depth_;
    gl::Framebuffer sample_framebuffer_; ///< over the samples; empty with one per pixel
    gl::Program resolve_program_;
};

} // namespace postfx::host
