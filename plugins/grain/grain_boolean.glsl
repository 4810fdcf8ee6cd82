#include "grain_film.glsl"

// The share of a pixel that discs leave bare, where discs lie at the points of a Poisson process. A cell is as wide as
// a disc with its edge of one pixel, `edge` cells; `mean` is how many discs it has. The number in a cell is where the
// cell's own uniform number falls among the distribution's steps (Poisson, inverted); 96 are enough for a mean below
// 40. What two discs leave bare of a pixel that both cut is the product, as if their edges crossed at random.
float grain_bare(vec2 place, float mean, float edge, uint key) {
    vec2 first = floor(place + 0.5); // cells are counted from 1: (first - 1) to first, so none is negative
    float bare = 1.0;
    for (int cell = 0; cell < 4; ++cell) {
        vec2 corner = first - 1.0 + vec2(cell & 1, cell >> 1);
        uint word = grain_word(grain_place(ivec2(corner) + 1), key);
        float number = float(word >> 8u) * (1.0 / 16777216.0);
        float share = exp(-mean), sum = share;
        for (int i = 0; i < 96 && number >= sum; ++i) {
            word = grain_mixed(word + 0x9e3779b9u);
            vec2 away = corner + (vec2(word & 0xffffu, word >> 16u) + 0.5) * (1.0 / 65536.0) - place;
            bare *= 1.0 - clamp((0.5 - length(away)) / edge, 0.0, 1.0);
            share *= mean / float(i + 1);
            sum += share;
        }
    }
    return bare;
}

// The mean of layers, each covered in part, normalised. A film is many layers of grain over one another; at a given
// place each is covered with probability `light`. By the Poisson process's law the mean of `bare` is 1 - light, and
// that of its square (1 - light)^(2 - square_share), where square_share is the integral of a disc's cover squared
// over that of its cover.
float grain_layers(vec2 place, float light, uint key, GrainBooleanParams params) {
    // From there on the field hardly changes, and its weight vanishes; the number of discs would have no end.
    float covered = clamp(light, 0.001, 0.999);
    float density = -log(1.0 - covered);
    float sum = 0.0;
    for (int layer = 0; layer < GRAIN_LAYERS; ++layer) {
        key = grain_mixed(key + 0x9e3779b9u);
        sum += grain_bare(place, density * params.discs, params.frequency, key);
    }
    const float layers = float(GRAIN_LAYERS);
    float bare = 1.0 - covered;
    float variance = bare * bare * (exp(density * params.square_share) - 1.0);
    return (bare - sum / layers) * sqrt(layers / variance);
}

vec3 grain_boolean(vec3 color, Pixel pixel, GrainBooleanParams params) {
    uint key = grain_key(params.key);
    vec2 place = pixel.position * params.frequency;
    vec3 field = vec3(grain_layers(place, color.r, grain_mixed(key + 1u), params),
                      grain_layers(place, color.g, grain_mixed(key + 2u), params),
                      grain_layers(place, color.b, grain_mixed(key + 3u), params));
    return grain_on(color, field, params.own, params.joint);
}
