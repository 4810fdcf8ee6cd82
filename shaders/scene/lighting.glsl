// Light on a surface: Blinn-Phong with Schlick's Fresnel, normalised so that no exponent gives out more than came in
// (Akenine-Moeller et al., Real-Time Rendering, 3rd ed., 7.6). Lights are given as radiance of a white diffuse surface,
// so the 1/pi of both lobes is in them already: diffuse 1, specular (n + 8) / 8.

layout(binding = 4) uniform sampler2DArrayShadow u_shadows;

struct Radiance {
    vec3 direct;
    vec3 ambient; // the share that occlusion may darken
};

// 1 in light, 0 in shadow: 3x3 bilinear comparisons. Outside of the map everything is lit.
float scene_shadow(int layer, vec3 position, vec3 normal, vec3 to_light) {
    // Moved off the surface by a texel or two, more so at grazing light, against its shadowing itself.
    float texel_width = u_view.shadow_texel[layer].x * (u_view.world_to_shadow[layer] * vec4(position, 1.0)).w;
    vec3 lifted = position + normal * texel_width * (2.5 - 2.0 * dot(normal, to_light));
    vec4 clip = u_view.world_to_shadow[layer] * vec4(lifted, 1.0);
    vec3 place = clip.xyz / clip.w;
    place.xy = place.xy * 0.5 + 0.5;
    if (clip.w <= 0.0 || any(greaterThan(abs(place.xy - 0.5), vec2(0.5)))) return 1.0;
    float lit = 0.0;
    vec2 texel = 1.0 / vec2(textureSize(u_shadows, 0).xy);
    for (int y = -1; y <= 1; ++y) {
        for (int x = -1; x <= 1; ++x) {
            lit += texture(u_shadows, vec4(place.xy + texel * vec2(x, y), float(layer), place.z));
        }
    }
    return lit / 9.0;
}

vec3 scene_fresnel(vec3 head_on, float cosine) {
    float x = 1.0 - clamp(cosine, 0.0, 1.0);
    float x2 = x * x;
    return head_on + (1.0 - head_on) * (x2 * x2 * x);
}

vec3 scene_light(SceneLight light, Surface surface, vec3 to_eye) {
    vec3 to_light = -light.direction.xyz;
    float strength = 1.0;
    if (int(light.position.w) != SCENE_DIRECTIONAL) {
        vec3 offset = light.position.xyz - v_position;
        float distance = length(offset);
        to_light = offset / max(distance, 1e-6);
        strength = 1.0 / max(dot(light.attenuation.xyz, vec3(1.0, distance, distance * distance)), 1e-4);
    }
    if (int(light.position.w) == SCENE_SPOT) {
        float edge = clamp((dot(-to_light, light.direction.xyz) - light.direction.w) * light.color.w, 0.0, 1.0);
        strength *= edge * edge * (3.0 - 2.0 * edge);
    }
    float cosine = dot(surface.normal, to_light);
    if (cosine <= 0.0 || strength <= 0.0) return vec3(0.0);
    if (light.attenuation.w >= 0.0) {
        strength *= scene_shadow(int(light.attenuation.w), v_position, surface.normal, to_light);
    }
    vec3 halfway = normalize(to_light + to_eye);
    float lobe = pow(max(dot(surface.normal, halfway), 0.0), surface.shininess) * (surface.shininess + 8.0) / 8.0;
    vec3 reflected = scene_fresnel(surface.specular, dot(halfway, to_eye)) * lobe;
    return light.color.rgb * (strength * cosine) * (surface.diffuse * (1.0 - surface.specular) + reflected);
}

Radiance scene_shade(Surface surface) {
    vec3 to_eye = mix(u_view.backward.xyz, normalize(u_view.eye.xyz - v_position), u_view.eye.w);
    vec3 direct = vec3(0.0);
    int count = int(u_view.backward.w);
    for (int i = 0; i < count; ++i) direct += scene_light(u_view.lights[i], surface, to_eye);

    vec3 around = mix(u_view.ambient_down.rgb, u_view.ambient_up.rgb, surface.normal.y * 0.5 + 0.5);
    // The background in the mirror direction; a dull surface sees little of it.
    float gloss = surface.shininess / (surface.shininess + 60.0);
    vec3 mirrored = scene_background(reflect(-to_eye, surface.normal)) * gloss;
    vec3 fresnel = scene_fresnel(surface.specular, dot(surface.normal, to_eye));
    vec3 ambient = around * surface.diffuse * (1.0 - surface.specular) + mirrored * fresnel;
    return Radiance(direct, ambient);
}
