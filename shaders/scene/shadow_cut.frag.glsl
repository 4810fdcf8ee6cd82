// Depth of a surface that is not there where its alpha is low.

layout(binding = 0) uniform sampler2D u_diffuse;

in vec2 v_uv;
in vec3 v_extra;

void main() {
    vec4 u = u_material.uv_rows[0], v = u_material.uv_rows[1];
    vec3 place = vec3(u.w > 0.5 ? v_extra.xy : v_uv, 1.0);
    float alpha = texture(u_diffuse, vec2(dot(u.xyz, place), dot(v.xyz, place))).a * u_material.diffuse.a * v_extra.z;
    if (alpha < u_material.emission.w) discard;
}
