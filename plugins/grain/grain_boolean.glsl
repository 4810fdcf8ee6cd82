#include "grain_film.glsl"

// Is the place covered by a disc of diameter 1, where discs lie at the points of a Poisson process? `mean` is how
// many there are in a cell of area 1. The number in a cell is where the cell's own uniform number falls among the
// distribution's steps (Poisson, inverted); 40 are enough for a mean below 9.
bool grain_is_covered(vec2 place, float mean, uint key) {
    vec2 first = floor(place + 0.5); // cells are counted from 1: (first - 1) to first, so none is negative
    bool is_covered = false;
    for (int cell = 0; cell < 4; ++cell) {
        vec2 corner = first - 1.0 + vec2(cell & 1, cell >> 1);
        uint word = grain_word(grain_place(ivec2(corner) + 1), key);
        float number = float(word >> 8u) * (1.0 / 16777216.0);
        float share = exp(-mean), sum = share;
        for (int i = 0; i < 40 && number >= sum; ++i) {
            word = grain_mixed(word + 0x9e3779b9u);
            vec2 away = corner + (vec2(word & 0xffffu, word >> 16u) + 0.5) * (1.0 / 65536.0) - place;
            is_covered = is_covered || dot(away, away) < 0.25;
            share *= mean / float(i + 1);
            sum += share;
        }
    }
    return is_covered;
}

// The mean of layers, each covered (1) or not (0), normalised. A film is many layers of grain over one another; at a
// given place each is covered with probability `light`.
float grain_layers(vec2 place, float light, uint key) {
    // From there on the field hardly changes, and its weight vanishes; the number of discs would have no end.
    float covered = clamp(light, 0.001, 0.999);
    float mean = -log(1.0 - covered) * (4.0 / 3.14159265); // a disc covers pi / 4
    float count = 0.0;
    for (int layer = 0; layer < GRAIN_LAYERS; ++layer) {
        key = grain_mixed(key + 0x9e3779b9u);
        count += grain_is_covered(place, mean, key) ? 1.0 : 0.0;
    }
    const float layers = float(GRAIN_LAYERS);
    return (count / layers - covered) * sqrt(layers / (covered * (1.0 - covered)));
}

vec3 grain_boolean(vec3 color, Pixel pixel, GrainBooleanParams params) {
    uint key = grain_key(params.key);
    vec2 place = pixel.position * params.frequency;
    vec3 field = vec3(grain_layers(place, color.r, grain_mixed(key + 1u)),
                      grain_layers(place, color.g, grain_mixed(key + 2u)),
                      grain_layers(place, color.b, grain_mixed(key + 3u)));
    return grain_on(color, field, params.own, params.joint);
}
