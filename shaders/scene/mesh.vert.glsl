// Meshes: object space to clip space and to offsets from the eye.

layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec2 a_uv;
layout(location = 3) in vec3 a_tint;
layout(location = 4) in vec3 a_extra; // a second uv, opacity

layout(location = 0) uniform mat4 u_object_to_offset;
layout(location = 1) uniform mat3 u_normal_to_world;

// Depth alone is drawn first by another program, and has to come out the same to the last bit.
invariant gl_Position;

out vec3 v_offset; // metres
out vec3 v_normal; // world, not unit
out vec2 v_uv;
out vec3 v_tint;
out vec3 v_extra;

void main() {
    vec4 offset = u_object_to_offset * vec4(a_position, 1.0);
    v_offset = offset.xyz;
    v_normal = u_normal_to_world * a_normal;
    v_uv = a_uv;
    v_tint = a_tint;
    v_extra = a_extra;
    gl_Position = u_view.offset_to_clip * offset;
}
