#include "shader_library.hpp"

#include "view_block.hpp"

#include <postfx/error.hpp>
#include <postfx_scene_shaders.h>

#include <fmt/format.h>

#include <map>

namespace postfx::host {
namespace {

/// A shader's text with the names of the files that it came from.
class ShaderText {
public:
    ShaderText() {
        text_ = fmt::format("#version 450 core\n"
                            "const int SCENE_MAX_LIGHTS = {};\nconst int SCENE_MAX_SHADOWS = {};\n",
                            max_lights, max_shadows);
    }
    ShaderText& file(const std::string& name) {
        for (const postfx_source& source : postfx_embedded_sources) {
            if (name == source.name) {
                text_ += fmt::format("#line 1 {}\n{}\n", files_.size(), source.text);
                files_.emplace_back(source.path);
                return *this;
            }
        }
        throw Error(fmt::format("the scene has no shader piece {}", name));
    }
    ShaderText& made(const std::string& text) {
        text_ += fmt::format("#line 1 {}\n{}\n", files_.size(), text);
        files_.emplace_back("(generated for this scene)");
        return *this;
    }
    const std::string& text() const { return text_; }
    const std::vector<std::string>& files() const { return files_; }

private:
    std::string text_;
    std::vector<std::string> files_;
};

std::string declare_outputs(const OutputNames& outputs) {
    std::string text;
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        text += fmt::format("layout(location = {}) out vec4 o_{};\n", i, outputs[i]);
    }
    return text;
}

/// Largest finite half float: light beyond it stays finite in the targets.
constexpr const char* brightest = "vec3(65504.0)";

std::string mesh_outputs(const OutputNames& outputs) {
    const auto light = [](const std::string& value) {
        return fmt::format("vec4(min(({}) * opacity, {}), opacity)", value, brightest);
    };
    const std::map<std::string, std::string> values = {
        {"color", light("surface.emission + radiance.direct + radiance.ambient")},
        {"normal", "vec4(normalize(mat3(u_view.world_to_view) * surface.normal), 1.0)"},
        {"emission", light("surface.emission")},
        {"ambient", light("radiance.ambient")},
    };
    std::string text =
        declare_outputs(outputs) + "void scene_write(Surface surface, Radiance radiance, float opacity) {\n";
    for (const std::string& output : outputs)
        text += fmt::format("    o_{} = {};\n", output, values.at(output));
    return text + "}\n";
}

std::string light_calls(const std::vector<LightCode>& lights) {
    std::string text = "vec3 scene_direct(Surface surface, vec3 to_eye) {\n    vec3 sum = vec3(0.0);\n";
    for (std::size_t i = 0; i < lights.size(); ++i) {
        text += fmt::format("    {{\n        SceneLight light = u_view.lights[{}];\n", i);
        if (lights[i].kind == Light::Kind::directional) {
            text += "        vec3 to_light = -light.direction.xyz;\n        float strength = 1.0;\n";
        } else {
            text += "        vec3 offset = light.position.xyz - v_offset;\n"
                    "        float distance = length(offset);\n"
                    "        vec3 to_light = offset / max(distance, 1e-30);\n"
                    "        float strength = scene_attenuation(light.attenuation.xyz, distance);\n";
        }
        if (lights[i].ranged) text += "        strength *= scene_range(light.attenuation.w, distance);\n";
        if (lights[i].kind == Light::Kind::spot) text += "        strength *= scene_cone(light, to_light);\n";
        if (lights[i].shadow_layer >= 0) {
            text += fmt::format("        strength *= scene_shadow({}, surface.normal, to_light);\n",
                                lights[i].shadow_layer);
        }
        text +=
            "        sum += scene_reflect(light.color.rgb * strength, surface, to_light, to_eye);\n    }\n";
    }
    return text + "    return sum;\n}\n";
}

std::string surface_constants(const SurfaceCode& code) {
    const std::pair<const char*, bool> constants[] = {
        {"PLACED", code.placed},         {"EXTRA", code.extra},
        {"NORMAL_MAP", code.normal_map}, {"METAL_ROUGH", code.metal_rough},
        {"OCCLUDED", code.occluded},     {"CUT", code.cut},
        {"UNLIT", code.unlit},
    };
    std::string text;
    for (const auto& [name, value] : constants)
        text += fmt::format("const bool SCENE_{} = {};\n", name, value);
    return text;
}

/// Depth and number of the nearest sample.
std::string find_nearest(int samples) {
    std::string text = "    int nearest = 0;\n    float depth = texelFetch(u_depth, pixel, 0).r;\n";
    for (int i = 1; i < samples; ++i) {
        text += fmt::format("    float depth_{0} = texelFetch(u_depth, pixel, {0}).r;\n"
                            "    if (depth_{0} > depth) {{ depth = depth_{0}; nearest = {0}; }}\n",
                            i);
    }
    return text + "    gl_FragDepth = depth;\n";
}

std::string resolve_main(const OutputNames& outputs, int samples, bool depth) {
    std::string text = declare_outputs(outputs);
    if (depth) text += "layout(binding = 0) uniform sampler2DMS u_depth;\n";
    for (std::size_t i = 0; i < outputs.size(); ++i) {
        text += fmt::format("layout(binding = {}) uniform sampler2DMS u_{};\n", i + 1, outputs[i]);
    }
    text += "void main() {\n    ivec2 pixel = ivec2(gl_FragCoord.xy);\n";
    if (depth) text += find_nearest(samples);
    for (const std::string& output : outputs) {
        if (output == "normal") {
            text += "    o_normal = texelFetch(u_normal, pixel, nearest);\n";
            continue;
        }
        std::string sum;
        for (int i = 0; i < samples; ++i) {
            sum += fmt::format("{}texelFetch(u_{}, pixel, {})", i ? " + " : "", output, i);
        }
        text += fmt::format("    o_{} = ({}) * {};\n", output, sum, 1.0 / samples);
    }
    return text + "}\n";
}

gl::Program link(const ShaderText& vertex, const ShaderText& fragment, const std::string& what) {
    // The two stages number their files alone; the fragment's names serve, as the larger of the two.
    return gl::make_program(vertex.text(), fragment.text(), what, fragment.files());
}

} // namespace

SurfaceCode surface_code(const Material& material, bool extra) {
    const auto placed = [](const Texture& texture) { return texture && texture.is_placed(); };
    return {.textured = material.textured(),
            .placed = placed(material.diffuse_texture) || placed(material.emission_texture)
                      || placed(material.normal_texture) || placed(material.metal_roughness_texture)
                      || placed(material.occlusion_texture),
            .extra = extra,
            .normal_map = bool(material.normal_texture),
            .metal_rough = material.metal_rough,
            .occluded = bool(material.occlusion_texture),
            .cut = material.alpha_cutoff > 0,
            .unlit = material.unlit};
}

gl::Program make_mesh_program(const OutputNames& outputs, const SurfaceCode& surface,
                              const std::vector<LightCode>& lights) {
    ShaderText fragment;
    fragment.made(surface_constants(surface))
        .file("view.glsl")
        .file("material_block.glsl")
        .file("material.glsl");
    fragment.file(surface.textured ? "surface_textured.glsl" : "surface_plain.glsl");
    fragment.file("lighting.glsl").made(light_calls(lights)).file("shade.glsl");
    fragment.made(mesh_outputs(outputs)).file("mesh.frag.glsl");
    return link(ShaderText().file("view.glsl").file("mesh.vert.glsl"), fragment, "scene mesh");
}

gl::Program make_depth_program() {
    return link(ShaderText().file("view.glsl").file("mesh.vert.glsl"),
                ShaderText().file("depth_only.frag.glsl"), "scene depth");
}

gl::Program make_shadow_program() {
    return link(ShaderText().file("shadow.vert.glsl"), ShaderText().file("depth_only.frag.glsl"),
                "scene shadow");
}

gl::Program make_cut_shadow_program() {
    return link(ShaderText().file("shadow.vert.glsl"),
                ShaderText().file("material_block.glsl").file("shadow_cut.frag.glsl"),
                "scene shadow of cut surfaces");
}

gl::Program make_sky_program() {
    return link(ShaderText().file("view.glsl").file("sky.vert.glsl"),
                ShaderText().file("view.glsl").file("sky.frag.glsl"), "scene sky");
}

gl::Program make_resolve_program(const OutputNames& outputs, int samples, bool depth) {
    return link(ShaderText().file("resolve.vert.glsl"),
                ShaderText().made(resolve_main(outputs, samples, depth)), "scene resolve");
}

} // namespace postfx::host
