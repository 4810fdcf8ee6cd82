// Meshes as a light sees them: depth only.

layout(location = 0) in vec3 a_position;

layout(location = 0) uniform mat4 u_object_to_light; // clip space of the light

void main() {
    gl_Position = u_object_to_light * vec4(a_position, 1.0);
}
