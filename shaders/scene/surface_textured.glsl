// The surface at this fragment: textures times colours. A texture that the material lacks is one white texel.

layout(binding = 0) uniform sampler2D u_diffuse;
layout(binding = 1) uniform sampler2D u_emission;
layout(binding = 2) uniform sampler2D u_normal;
layout(binding = 3) uniform sampler2D u_metal_roughness;
layout(binding = 5) uniform sampler2D u_occlusion;

// Where a texture is read; `map`: 0 diffuse, 1 emission, 2 normal, 3 metal and roughness, 4 occlusion.
vec2 scene_uv(int map) {
    if (!SCENE_PLACED) return v_uv;
    vec4 u = u_material.uv_rows[2 * map], v = u_material.uv_rows[2 * map + 1];
    vec3 place = vec3(SCENE_EXTRA && u.w > 0.5 ? v_extra.xy : v_uv, 1.0);
    return vec2(dot(u.xyz, place), dot(v.xyz, place));
}

// Normal map without stored tangents: the frame comes from how position and uv change on the screen
// (Schueler, "Followup: Normal Mapping Without Precomputed Tangents", 2013).
vec3 scene_mapped_normal(vec3 normal) {
    vec2 uv = scene_uv(2);
    vec3 dx = dFdx(v_offset), dy = dFdy(v_offset);
    vec2 uv_dx = dFdx(uv), uv_dy = dFdy(uv);
    vec3 across = cross(dy, normal), along = cross(normal, dx);
    vec3 tangent = across * uv_dx.x + along * uv_dy.x;
    vec3 bitangent = across * uv_dx.y + along * uv_dy.y;
    float scale = inversesqrt(max(max(dot(tangent, tangent), dot(bitangent, bitangent)), 1e-37)); // against 0 alone
    vec3 mapped = texture(u_normal, uv).xyz * 2.0 - 1.0;
    mapped.xy *= u_material.factors.x;
    return normalize(mat3(tangent * scale, bitangent * scale, normal) * mapped);
}

Surface scene_surface() {
    Surface surface = scene_untextured();
    vec4 base = texture(u_diffuse, scene_uv(0));
    surface.diffuse *= base.rgb;
    surface.opacity *= base.a;
    if (SCENE_CUT && surface.opacity < u_material.emission.w) discard;
    surface.emission *= texture(u_emission, scene_uv(1)).rgb;
    if (SCENE_NORMAL_MAP) surface.normal = scene_mapped_normal(surface.normal);
    if (SCENE_METAL_ROUGH) {
        vec2 map = texture(u_metal_roughness, scene_uv(3)).gb;
        scene_metal_rough(surface, u_material.factors.w * map.y, u_material.factors.z * map.x);
    }
    if (SCENE_OCCLUDED) surface.openness += u_material.factors.y * (texture(u_occlusion, scene_uv(4)).r - 1.0);
    return surface;
}
