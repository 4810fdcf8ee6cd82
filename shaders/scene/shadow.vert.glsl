// Meshes as a light sees them.

layout(location = 0) in vec3 a_position;
layout(location = 2) in vec2 a_uv;
layout(location = 4) in vec3 a_extra; // a second uv, opacity

layout(location = 0) uniform mat4 u_object_to_light; // clip space of the light

out vec2 v_uv;
out vec3 v_extra;

void main() {
    v_uv = a_uv;
    v_extra = a_extra;
    gl_Position = u_object_to_light * vec4(a_position, 1.0);
}
