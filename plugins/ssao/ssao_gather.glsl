#include "ssao_distance.glsl"
#include "ssao_place.glsl"

// Ground-truth ambient occlusion (Jimenez et al. 2016): planes through the line of sight cut the surface, and on
// either side of it everything below the highest sample counts as solid. README.md has the model.

// What the samples of one slice share.
struct SsaoSlice {
    vec3 place;   // of the point [m]
    vec3 over;    // the normal divided by its length within the slice
    float slack;  // what the depth's own rounding can lift [m]
    float radius; // [m]
    float fade;   // 1 / the part of it over which samples fade out
};

// Elevation over the tangent plane of one texel, as 1 - cos times its weight; 0 if it does not rise above it, and -1 if
// it does, but beyond the radius.
float ssao_lift(vec2 texel, SsaoSlice slice, sampler2D distances) {
    texel = clamp(floor(texel + 0.5), vec2(0.0), vec2(textureSize(distances, 0) - 1));
    float z = texelFetch(distances, ivec2(texel), 0).r;
    vec3 to_sample = ssao_place(texel * ssao_plane_step() + ssao_plane_start(), z) - slice.place;
    // The texel may lie beside the slice; measured from the tangent plane, a plane's samples are never above it.
    float height = dot(to_sample, slice.over) - slice.slack;
    float squared = dot(to_sample, to_sample);
    float inverse = inversesqrt(max(squared, 1e-36));
    float inside = slice.radius - squared * inverse;
    float lift = 1.0 - sqrt(max(squared - height * height, 0.0)) * inverse;
    return height > 0.0 ? (inside > 0.0 ? lift * min(inside * slice.fade, 1.0) : -1.0) : 0.0;
}

// Highest elevation that the surface has on one side of a slice, as 1 - cos, at most 1; 0 if nothing rises above the
// tangent plane. toward: step on the screen [texels]; reach: how many. A surface that comes towards the eye leaves the
// radius where it is highest, within few texels: there the last samples close in.
float ssao_highest(vec2 from, vec2 toward, float reach, float jitter, SsaoSlice slice, sampler2D distances) {
    float highest = 0.0, before = 0.0, inside = 0.0, beyond = 0.0; // texels away
    for (int i = 0; i < SSAO_STEPS; ++i) {
        float t = (float(i) + jitter) / float(SSAO_STEPS);
        // Few samples stand closer together near the middle, where what they see fills a larger angle.
        float away = mix(1.0, max(reach, 1.0), SSAO_INTERLEAVED == 1 ? t * t : t);
        float lift = ssao_lift(from + away * toward, slice, distances);
        if (lift < 0.0 && beyond == 0.0) {
            inside = before;
            beyond = away;
        }
        before = away;
        highest = max(highest, lift);
    }
    for (int i = 0; i < (beyond > 0.0 ? SSAO_CLOSING : 0); ++i) {
        float away = 0.5 * (inside + beyond);
        float lift = ssao_lift(from + away * toward, slice, distances);
        inside = lift < 0.0 ? inside : away;
        beyond = lift < 0.0 ? away : beyond;
        highest = max(highest, lift);
    }
    return highest;
}

// Cosine-weighted share of light that a half of a slice loses to what rises to 1 - cos(elevation) = highest. Of the
// unit normal: its component towards the eye, the one towards this side, and both divided by its length in the slice.
float ssao_lost(float highest, float to_eye, float to_side, float cosine, float sine) {
    if (highest <= 0.0) return 0.0;
    float cos_up = 1.0 - min(highest, 1.0 + sine); // not beyond the line of sight
    float sin_up = sqrt(max(1.0 - cos_up * cos_up, 0.0));
    float sin_horizon = cosine * cos_up + sine * sin_up; // angles from the line of sight
    float cos_horizon = cosine * sin_up - sine * cos_up;
    return 0.5 * (to_eye * (cosine * cosine - sin_horizon * sin_horizon) +
                  to_side * (acos(cos_up) + cosine * sine + sin_horizon * cos_horizon));
}

// Texels to go, forward and backward, until the line of sight passes the sphere of influence by: the exact outline of
// the sphere. relative: its radius over z. step: of the plane at 1 m, per texel.
vec2 ssao_sphere_reach(vec2 plane, vec2 plane_step, float relative, float radius) {
    float step_squared = dot(plane_step, plane_step);
    if (u_frame.orthographic) return vec2(radius * inversesqrt(step_squared));
    float length_squared = dot(plane, plane) + 1.0;
    float along = dot(plane, plane_step);
    float a = length_squared * step_squared - along * along - relative * relative * step_squared;
    if (a <= 0.0) return vec2(1e9); // the eye is inside, or nearly
    float middle = relative * relative * along;
    float root = relative * sqrt(relative * relative * along * along + a * length_squared);
    return vec2(root + middle, root - middle) / a;
}

// Texels to go until the border: nothing is known beyond it.
float ssao_border_reach(vec2 from, vec2 toward, vec2 last) {
    vec2 room = mix(from, last - from, greaterThan(toward, vec2(0.0)));
    vec2 steps = room / max(abs(toward), vec2(1e-9));
    return min(steps.x, steps.y);
}

// Where a texel's slices and samples begin, both in 0..1: every 3x3 texels have 9 different ones of either, in pairs
// that fill the square evenly (the two digits to base 3 and, for the samples, the same in reverse).
vec2 ssao_phase(ivec2 index) {
    int a = (index.x + index.y) % 3, b = (index.x + 2 * index.y) % 3;
    return (vec2(3 * a + b, 3 * b + a) + 0.5) / 9.0;
}

// Occlusion of the ambient light, not yet held to 0..1, or -1 where it is not known; metres along the view axis.
vec4 ssao_gather(Pixel pixel, SsaoGatherParams params, sampler2D distances, sampler2D normals) {
    float z = texelFetch(distances, pixel.index, 0).r;
    vec3 normal = texelFetch(normals, pixel.index, 0).xyz;
    if (z == SSAO_NOTHING) return vec4(0.0, z, 0.0, 0.0);
    if (normal == vec3(0.0)) return vec4(-1.0, z, 0.0, 0.0);

    vec2 from = vec2(pixel.index), last = vec2(textureSize(distances, 0) - 1);
    vec2 plane_step = ssao_plane_step();
    vec2 plane = from * plane_step + ssao_plane_start();
    vec3 place = ssao_place(plane, z);
    vec3 eye = u_frame.orthographic ? vec3(0.0, 0.0, 1.0) : normalize(vec3(-plane, 1.0));
    float facing = dot(normal, eye);
    if (facing < 0.01) normal = normalize(normal + (0.01 - facing) * eye); // shading normals may look away
    float to_eye = dot(normal, eye);
    vec3 right = normalize(vec3(1.0, 0.0, 0.0) - eye.x * eye);
    vec3 up = cross(eye, right);

    // Four roundings of a depth sample near 1, where its float steps are largest: of z [m].
    float rounding = 2.4e-7 * (z + abs(u_frame.depth_affine.y) * (u_frame.orthographic ? 1.0 : z * z));
    float fade = 1.0 / (max(params.falloff, 1e-6) * params.radius);
    vec2 phase = SSAO_INTERLEAVED == 1 ? ssao_phase(pixel.index) : vec2(0.5, 1.0);

    float lost = 0.0;
    for (int i = 0; i < SSAO_SLICES; ++i) {
        float angle = (float(i) + phase.x) * (3.14159265 / float(SSAO_SLICES));
        vec3 side = cos(angle) * right + sin(angle) * up;
        vec2 toward = normalize((side.xy + (u_frame.orthographic ? vec2(0.0) : plane * side.z)) / plane_step);
        float to_side = dot(normal, side);
        float in_slice = inversesqrt(to_eye * to_eye + to_side * to_side);
        float cosine = to_eye * in_slice, sine = to_side * in_slice;
        vec2 reach = min(ssao_sphere_reach(plane, toward * plane_step, params.radius / z, params.radius),
                         vec2(ssao_border_reach(from, toward, last), ssao_border_reach(from, -toward, last)));
        SsaoSlice slice = SsaoSlice(place, normal * in_slice, rounding * cosine, params.radius, fade);
        float ahead = ssao_highest(from, toward, reach.x, phase.y, slice, distances);
        float behind = ssao_highest(from, -toward, reach.y, phase.y, slice, distances);
        lost += ssao_lost(ahead, to_eye, to_side, cosine, sine) + ssao_lost(behind, to_eye, -to_side, cosine, -sine);
    }
    return vec4(lost / float(SSAO_SLICES), z, 0.0, 0.0);
}
