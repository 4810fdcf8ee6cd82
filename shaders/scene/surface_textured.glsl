// The surface at this fragment: textures times colours. A texture that the material lacks is one white texel.

layout(binding = 0) uniform sampler2D u_diffuse;
layout(binding = 1) uniform sampler2D u_emission;
layout(binding = 2) uniform sampler2D u_normal;
layout(binding = 3) uniform sampler2D u_metal_roughness;

// Normal map without stored tangents: the frame comes from how position and uv change on the screen
// (Schueler, "Followup: Normal Mapping Without Precomputed Tangents", 2013).
vec3 scene_mapped_normal(vec3 normal) {
    vec3 dx = dFdx(v_position), dy = dFdy(v_position);
    vec2 uv_dx = dFdx(v_uv), uv_dy = dFdy(v_uv);
    vec3 across = cross(dy, normal), along = cross(normal, dx);
    vec3 tangent = across * uv_dx.x + along * uv_dy.x;
    vec3 bitangent = across * uv_dx.y + along * uv_dy.y;
    float scale = inversesqrt(max(max(dot(tangent, tangent), dot(bitangent, bitangent)), 1e-30));
    vec3 mapped = texture(u_normal, v_uv).xyz * 2.0 - 1.0;
    return normalize(mat3(tangent * scale, bitangent * scale, normal) * mapped);
}

Surface scene_surface() {
    vec4 base = texture(u_diffuse, v_uv) * vec4(v_tint * u_material.diffuse.rgb, u_material.diffuse.a);
    if (base.a < u_material.emission.w) discard;
    Surface surface = Surface(base.rgb, u_material.specular.rgb, u_material.specular.w,
                              texture(u_emission, v_uv).rgb * v_tint * u_material.emission.rgb, base.a,
                              normalize(v_normal));
    if (u_material.has_maps.x) surface.normal = scene_mapped_normal(surface.normal);
    if (u_material.has_maps.y) {
        vec2 roughness_metal = texture(u_metal_roughness, v_uv).gb;
        float alpha = max(roughness_metal.x * roughness_metal.x, 0.03);
        surface.specular = mix(vec3(0.04), base.rgb, roughness_metal.y);
        surface.diffuse = base.rgb * (1.0 - roughness_metal.y);
        surface.shininess = max(2.0 / (alpha * alpha) - 2.0, 1.0);
    }
    return surface;
}
