// What a material is made of, and what is known of a surface before light falls on it.

layout(std140, binding = 1) uniform SceneMaterial {
    vec4 diffuse;   // rgb; a: opacity
    vec4 specular;  // rgb; w: exponent
    vec4 emission;  // rgb; w: alpha below which nothing is there
    bvec4 has_maps; // x: normal, y: metal and roughness; z: blended
} u_material;

struct Surface {
    vec3 diffuse;
    vec3 specular; // seen head-on
    float shininess;
    vec3 emission;
    float opacity;
    vec3 normal; // world, unit
};

in vec3 v_position;
in vec3 v_normal;
in vec2 v_uv;
in vec3 v_tint;
