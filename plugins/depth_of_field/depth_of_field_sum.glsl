// Sums of discs' light. DEPTH_OF_FIELD_AXIAL: axial aberration gives each colour its own disc; without it the weights
// of all are in r.
struct DepthOfFieldSum {
    vec3 light, weights;
};

// Adds a texel by its share of a disc's light, up to a factor common to all: coverage over the square of the radius.
void depth_of_field_add(inout DepthOfFieldSum sum, vec3 light, float part, float radius, vec3 shift, float squared) {
    if (DEPTH_OF_FIELD_AXIAL == 1) {
        vec3 slope = 0.5 / max(radius + shift, 0.5);
        vec3 weights = part * clamp(0.25 / slope + 0.5 - squared * slope, 0.0, 1.0) * (slope * slope);
        sum.light += weights * light;
        sum.weights += weights;
    } else {
        float only = max(radius, 0.5);
        float slope = 0.5 / only;
        float weight = part * clamp(0.5 * only + 0.5 - squared * slope, 0.0, 1.0) * (slope * slope);
        sum.light += weight * light;
        sum.weights.r += weight;
    }
}

vec3 depth_of_field_weights(DepthOfFieldSum sum) {
    return DEPTH_OF_FIELD_AXIAL == 1 ? sum.weights : sum.weights.rrr;
}

vec3 depth_of_field_mean(DepthOfFieldSum sum) {
    return sum.light / max(depth_of_field_weights(sum), 1e-30);
}
