// First thing in every program that postfx assembles; nothing includes it.

// Where a function of a pass stands in the pass's target.
struct Pixel {
    ivec2 index;   // from the bottom left
    vec2 position; // of the pixel's centre: index + 0.5, in pixels
    vec2 uv;       // position / size
    ivec2 size;    // of the target, pixels
};

// What holds for the whole frame, as `u_frame`. Angles and metres as in postfx/camera.hpp.
struct Frame {
    vec2 size;            // of the picture, pixels
    vec2 inverse_size;    // 1 / size
    vec2 depth_affine;    // scale, offset: 1/z (perspective) or z (orthographic) from a raw depth sample
    float sky_depth;      // the raw sample that means "nothing there"; compare for equality
    float near_plane;     // metres
    vec2 half_extent;     // perspective: tan of half the field of view, x and y; orthographic: half the width, height [m]
    bool orthographic;
    float time;           // seconds; for motion only, never for noise
    uint frame;           // counts frames; noise is a function of (pixel, frame, seed)
    uint seed;
    vec2 principal_point; // where the optical axis lies, right and up from the picture's middle, in half widths and heights
    mat4 view_to_world;   // the camera looks down -z of its own space
};

// A pixel of the chain's stored colour. Here, before any effect's text, so that no effect can replace the texelFetch
// that it uses (GLSL lets a shader redefine built-in functions).
vec4 postfx_stored(sampler2D picture, ivec2 index) {
    return texelFetch(picture, index, 0);
}
