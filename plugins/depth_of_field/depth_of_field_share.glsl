// Part of a pixel that the blurred layers show: 0 up to a circle of 1 px, 1 from the smallest that they can blur by.
float depth_of_field_share(float circle) {
    return clamp((abs(circle) - 1.0) * DEPTH_OF_FIELD_SLOPE, 0.0, 1.0);
}
