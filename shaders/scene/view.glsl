// What is the same for a whole frame. Mirrored by view_block.hpp. An "offset" is a place relative to the eye, in the
// axes of the world: float32 holds the shape of what is near the eye, however far both are from the origin.

struct SceneLight {
    vec4 position;    // xyz: offset, metres
    vec4 direction;   // xyz: unit, where it shines; w: cosine of the outer angle
    vec4 color;       // rgb; w: 1 / (cosine of the inner angle - cosine of the outer angle)
    vec4 attenuation; // x, y, z of 1 / (x + y L + z L^2); w: metres to its end, if it has one
};

layout(std140, binding = 0) uniform SceneView {
    mat4 offset_to_clip;
    mat4 world_to_view;
    mat4 clip_to_direction; // (x, y, 1, 0) of the picture, -1..1, to a world direction, not unit
    vec4 backward;    // xyz: unit, against the view direction; w: 1 for a perspective camera, 0 for a parallel one
    vec4 zenith;      // rgb; w: radiance of the brightest stars
    vec4 horizon;     // rgb; w: share of the disc's halo
    vec4 ground;      // rgb; w: cosine of the disc's angular radius
    vec4 disc_color;  // rgb; w: radians that a pixel spans
    vec4 disc;        // xyz: unit, towards the sun or moon; w: 1 if there is one
    vec4 ambient_up;
    vec4 ambient_down;
    vec4 shadow_texel[SCENE_MAX_SHADOWS]; // x: width of a texel at clip w 1, metres; y: softness, texels
    mat4 offset_to_shadow[SCENE_MAX_SHADOWS];
    SceneLight lights[SCENE_MAX_LIGHTS];
} u_view;

// Radiance of the background without stars and disc, in a unit direction of the world.
vec3 scene_background(vec3 direction) {
    vec3 above = mix(u_view.horizon.rgb, u_view.zenith.rgb, pow(max(direction.y, 0.0), 0.6));
    return mix(u_view.ground.rgb, above, smoothstep(-0.03, 0.01, direction.y));
}
