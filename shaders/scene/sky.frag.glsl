// The background: gradient, stars, and a sun or moon with its halo.

in vec3 v_direction;
layout(location = 0) out vec4 o_color;

// Two well-mixed words of a cell of the sky (PCG, Jarzynski and Olano 2020).
uvec2 scene_hash(uvec2 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v ^= v >> 16u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    return v ^ (v >> 16u);
}

// Points on a cube around the eye: one candidate per cell, a few of them bright. They are about as wide as a pixel,
// but never smaller, so that they neither vanish nor flicker when the view turns.
float scene_stars(vec3 direction) {
    vec3 a = abs(direction);
    float side = max(a.x, max(a.y, a.z));
    vec2 plane = a.x == side ? direction.yz : (a.y == side ? direction.xz : direction.xy);
    uint face = (a.x == side ? 0u : (a.y == side ? 2u : 4u)) + (direction.x + direction.y + direction.z > 0.0 ? 1u : 0u);
    const float cells = 70.0;
    vec2 place = (plane / side * 0.5 + 0.5) * cells;
    uvec2 bits = scene_hash(uvec2(place) + uvec2(face * 7919u, face * 104729u));
    vec2 unit = vec2(bits >> 8u) / 16777216.0;
    float magnitude = fract(unit.x * 97.0 + unit.y * 57.0);
    vec2 offset = fract(place) - (0.2 + 0.6 * unit);
    float radius = max(0.75 * u_view.disc_color.w * cells * 0.5 * side * 1.4, 0.008);
    float falloff = exp(-dot(offset, offset) / (radius * radius));
    return falloff * pow(magnitude, 9.0) * smoothstep(0.0, 0.25, direction.y);
}

void main() {
    vec3 direction = normalize(v_direction);
    vec3 color = scene_background(direction);
    if (u_view.zenith.w > 0.0) color += u_view.zenith.w * scene_stars(direction) * vec3(0.9, 0.95, 1.0);
    if (u_view.disc.w > 0.0) {
        // Angles from the chord: near 0 the cosine has no digits left in float32.
        float angle = 2.0 * asin(min(0.5 * length(direction - u_view.disc.xyz), 1.0));
        float radius = acos(u_view.ground.w);
        float edge = u_view.disc_color.w;
        float inside = 1.0 - smoothstep(radius - edge, radius + edge, angle);
        float halo = u_view.horizon.w * (exp(-angle * 9.0) * 0.35 + exp(-angle * 40.0) * 0.65);
        color += u_view.disc_color.rgb * max(inside, halo);
    }
    o_color = vec4(color, 1.0);
}
