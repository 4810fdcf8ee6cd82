// What was found in every pixel of an image, for decisions (plugin.h, postfx_decision).

// Of a colour. A NaN anywhere makes all of them NaN, so that comparisons fail and the effect runs.
struct Census {
    vec3 lowest, highest; // per channel
};

// Of a depth attachment, in metres along the view axis; the sky does not count.
struct DepthCensus {
    float nearest, farthest; // without a surface: +infinity and 0. NaN if a sample is
    bool has_surface, has_sky;
};
