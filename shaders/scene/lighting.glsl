// Light on a surface: Blinn-Phong with Schlick's Fresnel, normalised so that no exponent gives out more than came in
// (Akenine-Moeller et al., Real-Time Rendering, 3rd ed., 7.6). Lights are given as radiance of a white diffuse surface,
// so the 1/pi of both lobes is in them already: diffuse 1, specular (n + 8) / 8.

layout(binding = 4) uniform sampler2DArrayShadow u_shadows;

// 1 in light, 0 in shadow: four bilinear comparisons, together a smooth filter. Outside of the map everything is lit.
float scene_shadow(int layer, vec3 normal, vec3 to_light) {
    // Moved off the surface against its shadowing itself: a plane at angle t to the light rises by the filter's half
    // width times sin(t), and the filter is half as wide again across its diagonal.
    float cosine = clamp(dot(normal, to_light), 0.0, 1.0);
    float softness = u_view.shadow_texel[layer].y;
    mat4 offset_to_shadow = u_view.offset_to_shadow[layer];
    float texel_width = u_view.shadow_texel[layer].x * (offset_to_shadow * vec4(v_offset, 1.0)).w;
    vec3 lifted = v_offset + normal * texel_width * (0.3 + 1.5 * (softness + 1.0) * sqrt(1.0 - cosine * cosine));
    vec4 clip = offset_to_shadow * vec4(lifted, 1.0);
    vec3 place = clip.xyz / clip.w;
    place.xy = place.xy * 0.5 + 0.5;
    float texel = softness / float(textureSize(u_shadows, 0).x);
    float lit = 0.25 * (texture(u_shadows, vec4(place.xy + vec2(-texel, -texel), float(layer), place.z))
                        + texture(u_shadows, vec4(place.xy + vec2(texel, -texel), float(layer), place.z))
                        + texture(u_shadows, vec4(place.xy + vec2(-texel, texel), float(layer), place.z))
                        + texture(u_shadows, vec4(place.xy + vec2(texel, texel), float(layer), place.z)));
    bool beyond = clip.w <= 0.0 || any(greaterThan(abs(place.xy - 0.5), vec2(0.5)));
    return beyond ? 1.0 : lit;
}

vec3 scene_fresnel(vec3 head_on, float cosine) {
    float x = 1.0 - clamp(cosine, 0.0, 1.0);
    float x2 = x * x;
    return head_on + (1.0 - head_on) * (x2 * x2 * x);
}

// Light of that colour from a unit direction.
vec3 scene_reflect(vec3 color, Surface surface, vec3 to_light, vec3 to_eye) {
    vec3 halfway = normalize(to_light + to_eye);
    float lobe = pow(max(dot(surface.normal, halfway), 0.0), surface.shininess) * (surface.shininess + 8.0) / 8.0;
    vec3 reflected = scene_fresnel(surface.specular, dot(halfway, to_eye)) * lobe;
    return color * max(dot(surface.normal, to_light), 0.0) * (surface.diffuse * (1.0 - surface.specular) + reflected);
}

float scene_attenuation(vec3 factors, float distance) {
    return 1.0 / max(dot(factors, vec3(1.0, distance, distance * distance)), 1e-30); // against 0 alone
}

// A light's end, as KHR_lights_punctual has it: 1 nearby, 0 from `range` on.
float scene_range(float range, float distance) {
    float share = distance / range;
    return clamp(1.0 - share * share * share * share, 0.0, 1.0);
}

// 1 inside of the inner angle, 0 outside of the outer one.
float scene_cone(SceneLight light, vec3 to_light) {
    float edge = clamp((dot(-to_light, light.direction.xyz) - light.direction.w) * light.color.w, 0.0, 1.0);
    return edge * edge * (3.0 - 2.0 * edge);
}
