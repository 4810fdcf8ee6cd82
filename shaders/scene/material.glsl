// What a material is made of, and what is known of a surface before light falls on it. Which of it a program needs is
// said by constants that are generated for it: SCENE_PLACED, SCENE_EXTRA, SCENE_NORMAL_MAP,
// SCENE_METAL_ROUGH, SCENE_OCCLUDED, SCENE_CUT, SCENE_UNLIT.

struct Surface {
    vec3 diffuse;
    vec3 specular; // seen head-on
    float shininess;
    vec3 emission;
    float opacity;
    vec3 normal;    // world, unit
    float openness; // share of the ambient light that arrives
};

in vec3 v_offset;
in vec3 v_normal;
in vec2 v_uv;
in vec3 v_tint;
in vec3 v_extra;

// Metalness and roughness in terms of diffuse, specular and exponent; diffuse is the base colour before. The exponent is
// the usual match of Blinn-Phong and Beckmann (Walter et al. 2007).
void scene_metal_rough(inout Surface surface, float metalness, float roughness) {
    vec3 base = surface.diffuse;
    float alpha = max(roughness * roughness, 0.03);
    surface.specular = mix(surface.specular, base, metalness);
    surface.diffuse = base * (1.0 - metalness);
    surface.shininess = max(2.0 / (alpha * alpha) - 2.0, 1.0);
}

// Colours of the material times those of the vertices.
Surface scene_untextured() {
    float opacity = u_material.diffuse.a * (SCENE_EXTRA ? v_extra.z : 1.0);
    vec3 emission = u_material.emission.rgb * (SCENE_METAL_ROUGH ? vec3(1.0) : v_tint);
    return Surface(v_tint * u_material.diffuse.rgb, u_material.specular.rgb, u_material.specular.w, emission, opacity,
                   normalize(v_normal), 1.0);
}
