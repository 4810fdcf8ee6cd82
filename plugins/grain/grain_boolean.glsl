#include "grain_film.glsl"

// exp(x) - 1 and -log(1 - x) that are not rounded away where x is small: the power series below 0.05.
float grain_grown(float x) {
    return abs(x) < 0.05 ? x * (1.0 + x / 2.0 * (1.0 + x / 3.0 * (1.0 + x / 4.0 * (1.0 + x / 5.0)))) : exp(x) - 1.0;
}
float grain_density(float x) {
    return x < 0.05 ? x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 3.0 + x * (1.0 / 4.0 + x / 5.0)))) : -log(1.0 - x);
}

// The share of a pixel that discs leave bare, where discs lie at the points of a Poisson process. A cell is as wide as
// a disc with its edge of one pixel, `edge` cells; `mean` is how many discs it has. There is another disc as long as
// the cell's own uniform number is below the probability that there are more; 96 are enough for a mean below 40. What
// two discs leave bare of a pixel that both cut is the product, as if their edges crossed at random.
float grain_bare(vec2 place, float mean, float edge, uint key) {
    vec2 first = floor(place + 0.5); // cells are counted from 1: (first - 1) to first, so none is negative
    float bare = 1.0;
    for (int cell = 0; cell < 4; ++cell) {
        vec2 corner = first - 1.0 + vec2(cell & 1, cell >> 1);
        uint word = grain_word(grain_place(ivec2(corner) + 1), key);
        float number = float(word >> 8u) * (1.0 / 16777216.0);
        float share = exp(-mean), more = -grain_grown(-mean);
        for (int i = 0; i < 96 && number < more; ++i) {
            word = grain_mixed(word + 0x9e3779b9u);
            vec2 away = corner + (vec2(word & 0xffffu, word >> 16u) + 0.5) * (1.0 / 65536.0) - place;
            bare *= 1.0 - clamp((0.5 - length(away)) / edge, 0.0, 1.0);
            share *= mean / float(i + 1);
            more -= share;
        }
    }
    return bare;
}

// The sum of what so many layers cover.
float grain_covered(vec2 place, float mean, float edge, uint key, int layers) {
    float sum = 0.0;
    for (int layer = 0; layer < layers; ++layer) {
        key = grain_mixed(key + 0x9e3779b9u);
        sum += 1.0 - grain_bare(place, mean, edge, key);
    }
    return sum;
}

// Light as the weighted mean of layers and of the light itself. A film is many layers of grain over one another; at a
// given place each is covered with probability `light`. Some layers are common to the channels, some a channel's own.
// By the Poisson process's law the mean of `bare` is 1 - light, and that of its square (1 - light)^(2 - square_share),
// where square_share is the integral of a disc's cover squared over that of its cover. What is covered is within 0..1
// and has the mean `light`, and so has every mixture of the two: nothing has to be cut, and the mean stays.
float grain_layers(vec2 place, float light, uint common_key, uint own_key, GrainBooleanParams params) {
    // Beyond these ends grains get dimmer instead of fewer: their number would have no end, or the hash too few bits.
    const float least = 1.0 / 8192.0, most = 0.999;
    if (!(light > 0.0 && light < 1.0)) return light;
    float mean = clamp(light, least, most), bare = 1.0 - mean;
    float density = grain_density(mean);
    float variance = bare * bare * grain_grown(density * params.square_share); // of one layer
    float discs = density * params.discs;
    float covered =
        params.common_weight * grain_covered(place, discs, params.frequency, common_key, params.common_layers) +
        params.own_weight * grain_covered(place, discs, params.frequency, own_key, params.own_layers);
    float share = min(params.deviation * sqrt(mean * bare / variance), 1.0);
    return light + share * min(light / least, 1.0) * min((1.0 - light) / (1.0 - most), 1.0) * (covered - mean);
}

vec3 grain_boolean(vec3 color, Pixel pixel, GrainBooleanParams params) {
    uint key = grain_key(params.key);
    vec2 place = pixel.position * params.frequency;
    return vec3(grain_layers(place, color.r, key, grain_mixed(key + 1u), params),
                grain_layers(place, color.g, key, grain_mixed(key + 2u), params),
                grain_layers(place, color.b, key, grain_mixed(key + 3u), params));
}
