// The uniform block of a material. Mirrored by view_block.hpp.

layout(std140, binding = 1) uniform SceneMaterial {
    vec4 diffuse;     // rgb; a: opacity
    vec4 specular;    // rgb; w: exponent
    vec4 emission;    // rgb; w: alpha below which nothing is there
    vec4 factors;     // x: of the normal map, y: of occlusion, z: of roughness, w: of metalness
    vec4 uv_rows[10]; // for each texture those of u and of v: xyz: factors of (u, v, 1); w: 1 for the second uv
    bvec4 is;         // x: blended
} u_material;
