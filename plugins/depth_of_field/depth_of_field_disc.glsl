// Share of a disc's light in the texel at that distance from its centre: a disc with an edge one texel wide, divided by
// its area. All in texels; radius at least 0.5.
float depth_of_field_disc(float radius, float away) {
    return clamp(radius - away + 0.5, 0.0, 1.0) / (3.14159265 * (radius * radius + 1.0 / 12.0));
}
