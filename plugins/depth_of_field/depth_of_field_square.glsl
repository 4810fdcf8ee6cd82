#include "depth_of_field_disc.glsl"

// The gathers work on squares of 2x2 texels, which share what they read: the texels of a vector lie at (0, 0), (1, 0),
// (0, 1) and (1, 1) of the square. Reading is what gathers cost, more so on software rasterisers.

// Distances from the first of a square's texels, and from the one in the next row, to what lies at (x, y) from the
// first. Those of the others are what these were one column before.
vec2 depth_of_field_distances(int x, int y) {
    vec2 rows = vec2(y, y - 1);
    return sqrt(float(x * x) + rows * rows);
}

// Columns that a row has to the left of the square's first texel, and to the right of its second, within that
// distance of the nearer row of the square.
int depth_of_field_square_columns(float extent, int y) {
    return depth_of_field_columns(extent, float(y > 0 ? y - 1 : -y));
}

// Sums of discs' light on the texels of a square. DEPTH_OF_FIELD_AXIAL: axial aberration gives each colour its own
// discs; without it the weights of all are the green ones.
struct DepthOfFieldSquare {
    vec4 red, green, blue;
    vec4 red_weights, green_weights, blue_weights;
};

DepthOfFieldSquare depth_of_field_empty_square() {
    return DepthOfFieldSquare(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
}

// The share of a disc's light that falls on a texel, up to a factor common to all. By a radius and its inverse, so that
// those who have it needn't divide.
vec4 depth_of_field_density(vec4 radius, vec4 inverse, vec4 distance) {
    return depth_of_field_disc(radius, distance) * inverse * inverse;
}

// The same of a colour's own disc. Axial aberration changes the circle, not the gathered disc: all that else spreads
// light is added to that and taken off again. shift: half of the change of the circle, texels.
vec4 depth_of_field_shifted_density(vec4 radius, float shift, vec4 distance) {
    vec4 circle = sqrt(max(radius * radius + DEPTH_OF_FIELD_SPREAD, 0.0)) + shift;
    vec4 shifted = sqrt(max(max(circle, 0.0) * circle - DEPTH_OF_FIELD_SPREAD, 0.25));
    return depth_of_field_density(shifted, 1.0 / shifted, distance);
}

// Adds a texel to each of the square by its part there. radius: at least 0.5; density: of discs of that radius; shift:
// half of the change of the circles of red and blue, texels.
void depth_of_field_add(inout DepthOfFieldSquare sum, vec3 light, vec4 part, vec4 density, vec4 radius, vec2 shift,
                        vec4 distance) {
    vec4 green = part * density, red = green, blue = green;
    if (DEPTH_OF_FIELD_AXIAL == 1) {
        red = part * depth_of_field_shifted_density(radius, shift.x, distance);
        blue = part * depth_of_field_shifted_density(radius, shift.y, distance);
        sum.red_weights += red;
        sum.blue_weights += blue;
    }
    sum.green_weights += green;
    sum.red += red * light.r;
    sum.green += green * light.g;
    sum.blue += blue * light.b;
}

// Of one texel of the square:
vec3 depth_of_field_light(DepthOfFieldSquare sum, int i) {
    return vec3(sum.red[i], sum.green[i], sum.blue[i]);
}

vec3 depth_of_field_weights(DepthOfFieldSquare sum, int i) {
    if (DEPTH_OF_FIELD_AXIAL == 0) return vec3(sum.green_weights[i]);
    return vec3(sum.red_weights[i], sum.green_weights[i], sum.blue_weights[i]);
}

vec3 depth_of_field_mean(DepthOfFieldSquare sum, int i) { // 0 where nothing was added
    return depth_of_field_light(sum, i) / max(depth_of_field_weights(sum, i), 1e-30);
}
