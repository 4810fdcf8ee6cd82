// All light on a surface. scene_direct is generated: one call per light of the scene.

struct Radiance {
    vec3 direct;
    vec3 ambient; // the share that occlusion may darken
};

// From the surface to the viewer, unit.
vec3 scene_to_eye() {
    return mix(u_view.backward.xyz, normalize(-v_offset), u_view.backward.w);
}

Radiance scene_shade(Surface surface) {
    if (SCENE_UNLIT) return Radiance(surface.diffuse, vec3(0.0));
    vec3 to_eye = scene_to_eye();
    vec3 direct = scene_direct(surface, to_eye);
    vec3 around = mix(u_view.ambient_down.rgb, u_view.ambient_up.rgb, surface.normal.y * 0.5 + 0.5);
    // The background in the mirror direction; a dull surface sees little of it.
    float gloss = surface.shininess / (surface.shininess + 60.0);
    vec3 mirrored = scene_background(reflect(-to_eye, surface.normal)) * gloss;
    vec3 fresnel = scene_fresnel(surface.specular, dot(surface.normal, to_eye));
    vec3 ambient = around * surface.diffuse * (1.0 - surface.specular) + mirrored * fresnel;
    return Radiance(direct, ambient * surface.openness);
}
