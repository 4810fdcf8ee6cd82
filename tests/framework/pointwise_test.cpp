// The scan that decides whether GLSL may be a compose function.
#include <catch2/catch.hpp>

#include <plugin/pointwise.hpp>

#include <string>
#include <vector>

using postfx::why_not_pointwise;

namespace {

struct Case {
    std::string glsl;
    std::string why; ///< "" = pointwise
};

std::string function(const std::string& body) {
    return "vec3 shade(vec3 color, Pixel pixel, ShadeParams params, sampler2D side) {\n" + body + "\n}\n";
}

} // namespace

TEST_CASE("what sees only its own pixel and its arguments is let through") {
    const std::vector<std::string> good = {
        "",
        function("    return color;"),
        function("    return color * textureLod(side, pixel.uv, 0.0).rgb;"),
        function("    return texelFetch(side, pixel.index, 0).rgb;"),
        function("    return vec3(textureSize(side, 0), 1.0) + textureGather(side, pixel.uv).rgb;"),
        function("    return textureGrad(side, pixel.uv, vec2(0.1), vec2(0.1)).rgb;"),
        "#include <postfx/numeric.glsl>\n" + function("    return postfx_finite_or(color, 1.0);"),
        "#define SHADE_SQUARE(x) ((x) * (x))\n" + function("    return SHADE_SQUARE(color);"),
        "  #  define SHADE_HALF 0.5\n" + function("    return SHADE_HALF * color;"),
        "/* a note */ #define SHADE_HALF 0.5\n",
        "const float SHADE_WEIGHTS[2] = float[2](0.25, 0.75);\n" + function("    return color;"),
        "struct ShadeTap { vec2 at; float weight; };\n" + function("    return color;"),
        "float shade_helper(float x);\nfloat shade_helper(float x) { return x; }\n",
        "void shade_parts(in vec3 color, out vec3 low, inout vec3 high) { low = color; high += color; }\n",
        // Forbidden words are words, not parts of words, and comments are no code.
        function("    float uniformity = 1.0, my_texture = 2.0, mygl_thing = 3.0, in_focus = 4.0;\n"
                 "    return color * uniformity;"),
        "// dFdx, gl_FragCoord and discard are not used here\n" + function("    return color;"),
        "/* uniform float u_x;\n   #undef texelFetch\n */\n" + function("    return color;"),
        function("    // uniform /* not open\n    return color; // */ still code before"),
        function("    return color / 2.0; /**/"),
        function("    return color /* dFdx */ * 2.0;"),
        "vec3 shade(vec3 color)\r\n{\r\n    return color; // dFdx\r\n}\r\n",
    };
    for (const std::string& glsl : good) {
        INFO(glsl);
        CHECK(why_not_pointwise(glsl) == "");
    }
}

TEST_CASE("what could reach further is refused, with line and reason") {
    const std::vector<Case> bad = {
        {function("    return dFdx(color);"), "line 2: uses dFdx"},
        {function("\n    return fwidthFine(color);"), "line 3: uses fwidthFine"},
        {function("    return color * gl_FragCoord.x;"), "line 2: uses gl_FragCoord"},
        {function("    return texture(side, pixel.uv).rgb;"), "line 2: uses texture"},
        {function("    return textureOffset(side, pixel.uv, ivec2(1)).rgb;"), "line 2: uses textureOffset"},
        {function("    return textureProj(side, vec3(pixel.uv, 1.0)).rgb;"), "line 2: uses textureProj"},
        {function("    return vec3(textureQueryLod(side, pixel.uv), 0.0);"), "line 2: uses textureQueryLod"},
        {function("    if (color.r < 0.0) discard;\n    return color;"), "line 2: uses discard"},
        {"uniform float u_x;\n", "line 1: uses uniform"},
        {"layout(binding = 0) uniform sampler2D u_color;\n", "line 1: uses layout"},
        {"buffer Numbers { float x[]; };\n", "line 1: uses buffer"},
        {"shared float x;\n", "line 1: uses shared"},
        {"in vec2 v_uv;\n", "line 1: declares a shader input"},
        {"flat in int v_index;\n", "line 1: declares a shader input"},
        {"\nout vec4 o_more;\n", "line 2: declares a shader output"},
        {"vec3 shade(vec3 color) { return color; }\nout vec4 o_more;\n", "line 2: declares a shader output"},
        {"float f(usampler2D s);\n", "line 1: uses usampler2D"},
        {"float f(sampler2DArray s);\n", "line 1: uses sampler2DArray"},
        {"float f(samplerCube s);\n", "line 1: uses samplerCube"},
        {"float f(image2D s);\n", "line 1: uses image2D"},
        {function("    imageStore(side, pixel.index, vec4(1.0));"), "line 2: uses imageStore"},
        {function("    atomicAdd(x, 1);"), "line 2: uses atomicAdd"},
        {function("    barrier();"), "line 2: uses barrier"},
        {"subroutine vec3 choice(vec3 color);\n", "line 1: uses subroutine"},
        {"#undef texelFetch\n", "line 1: has the directive #undef"},
        {"#extension GL_ARB_shader_image_load_store : enable\n", "line 1: has the directive #extension"},
        {"#version 460\n", "line 1: has the directive #version"},
        {"\n#pragma once\n", "line 2: has the directive #pragma"},
        {"#if 1\n#endif\n", "line 1: has the directive #if"},
        {"#line 1 1\n", "line 1: has the directive #line"},
        {"#includes <postfx/depth.glsl>\n", "line 1: has the directive #includes"},
        {"# /* gap */ undef texelFetch\n", "line 1: has the directive #undef"},
        // Macros: their text is code, and they may not rename what the framework writes after them.
        {"#define SHADE_HERE gl_FragCoord\n", "line 1: uses gl_FragCoord"},
        {"#define SHADE_JOIN(a, b) a##b\n", "line 1: has a # inside a line"},
        {"#define texelFetch(a, b, c) textureLod(a, vec2(0.5), 0.0)\n",
         "line 1: defines the macro texelFetch, whose name is not in capitals"},
        {"#define pixel Pixel(ivec2(0), vec2(0.0), vec2(0.0), ivec2(1))\n",
         "line 1: defines the macro pixel, whose name is not in capitals"},
        // Tricks: what a scanner takes for a comment and a compiler does not.
        {"float a; // note \\\n/*\nfloat b = gl_FragCoord.x;\n// */\n",
         "line 1: has a line continuation, which could hide a directive"},
        {"#define SHADE \\\n  1\n", "line 1: has a line continuation, which could hide a directive"},
        {"// note\rfloat a = gl_FragCoord.x;\n", "line 1: has a carriage return inside a line"},
        {"/* never closed\nfloat a;\n", "line 1: has a comment without an end"},
        {"float f(float x) { return x; }\n/*\n#include \"other.glsl\"\n*/\n",
         "line 3: has an #include in a comment"},
        {"#include \"other.glsl\" /*\nfloat f() { return gl_FragCoord.x; }\n// */\n",
         "line 1: has a comment behind an #include"},
        {"#define SHADE_OPEN {\nout vec4 o_more;\n", "line 1: defines a macro that leaves a bracket open"},
        {"#define SHADE_TURN } {\n", "line 1: closes a bracket that is not open"},
        {"}\nout vec4 o_more;\n", "line 1: closes a bracket that is not open"},
        {"/**/ float f(); # undef y\n", "line 1: has a # inside a line"},
        {function("    return color; /* a */ /* b */ discard;"), "line 2: uses discard"},
        {"/*/ gl_FragCoord /*/ uniform float x;\n", "line 1: uses uniform"},
        {"float f() { return 1.0 / /* x */ gl_FragCoord.x; }\n", "line 1: uses gl_FragCoord"},
        // A variable that outlives the call would join two instances in one pass.
        {"float shade_calls = 0.0;\n" + function("    return color;"),
         "line 1: declares the variable shade_calls outside functions"},
        {"\nuint shade_state;\n", "line 2: declares the variable shade_state outside functions"},
        {"float shade_a[3], shade_b;\n", "line 1: declares the variable shade_a outside functions"},
        {"struct Shade { float x; } shade_one;\n",
         "line 1: declares the variable shade_one outside functions"},
        {"#define SHADE_F(x) (x)\nfloat shade_calls;\n",
         "line 2: declares the variable shade_calls outside functions"},
    };
    for (const Case& c : bad) {
        INFO(c.glsl);
        CHECK(why_not_pointwise(c.glsl) == c.why);
    }
}

TEST_CASE("the scan ends on any text") {
    // Cut anywhere, the verdict may be anything but must come.
    const std::string text = "/* a */ #define A 1\n// b\nvec3 f(vec3 c) { return c / 2.0; } /* c */\r\n";
    for (std::size_t length = 0; length <= text.size(); ++length) {
        (void)why_not_pointwise(text.substr(0, length));
        (void)why_not_pointwise(text.substr(length));
    }
    CHECK(why_not_pointwise(text) == "");
}
