// A triangle over the whole picture, at infinite distance.

out vec3 v_direction; // world, not unit

void main() {
    vec2 clip = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(clip, 0.0, 1.0);
    v_direction = (u_view.clip_to_direction * vec4(clip, 1.0, 0.0)).xyz;
}
