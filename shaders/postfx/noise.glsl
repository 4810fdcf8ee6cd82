// Reproducible noise from integers: the same bits on every driver, for any frame count.

// Three well-mixed words from three (PCG3D, Jarzynski and Olano 2020, JCGT 9(3)).
uvec3 postfx_hash(uvec3 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v ^= v >> 16u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

// Uniform in [0, 1): the top 24 bits, exact in float32.
vec3 postfx_unit(uvec3 bits) {
    return vec3(bits >> 8u) * (1.0 / 16777216.0);
}

// Three uniform numbers in [0, 1) for a pixel of this frame; `stream` keeps users of the same pixel apart.
vec3 postfx_pixel_noise(ivec2 index, uint stream) {
    return postfx_unit(postfx_hash(uvec3(uint(index.x) | (uint(index.y) << 16u), u_frame.frame,
                                         u_frame.seed * 0x9e3779b9u + stream)));
}
