// Random words from integers, the same on every driver and for any frame, and what all levels do with their noise.

// A bijection of words in which every bit of the input changes half of the output (C. Wellons 2018, "lowbias32").
uint grain_mixed(uint v) {
    v ^= v >> 16u;
    v *= 0x7feb352du;
    v ^= v >> 15u;
    v *= 0x846ca68bu;
    return v ^ (v >> 16u);
}

// What keeps frames and seeds apart; odd factors, so that no two frames and no two seeds coincide.
uint grain_key(int seed_key) {
    return grain_mixed(u_frame.frame * 0x9e3779b9u + u_frame.seed * 0x85ebca6bu + uint(seed_key));
}

// A place of a lattice as one word; coordinates below 65536.
uint grain_place(ivec2 place) {
    return uint(place.x) | (uint(place.y) << 16u);
}

// The word of a place. The first factor keeps the coordinates' bits from cancelling in the shift by 16. The key
// enters twice: once only, and another frame would be the same words at other places.
uint grain_word(uint place, uint key) {
    uint v = place * 0x9e3779b9u + key;
    v ^= v >> 16u;
    v *= 0x7feb352du;
    v = (v ^ (v >> 15u)) + key;
    v *= 0x846ca68bu;
    return v ^ (v >> 16u);
}

// Three independent numbers of mean 0 and variance 1, uniform in +-sqrt(3): ten bits each are enough for noise.
vec3 grain_numbers(uint word) {
    return (vec3(word & 1023u, (word >> 10u) & 1023u, word >> 22u) - 511.5) * (3.4641016 / 1024.0);
}

// Mean u and variance proportional to u (1 - u), as the Boolean model of grains gives (Newson, Delon, Galerne 2017).
// field: per channel mean 0, variance 1, independent; own and joint mix the channels.
vec3 grain_on(vec3 color, vec3 field, float own, float joint) {
    vec3 noise = own * field + joint * (field.r + field.g + field.b);
    vec3 deviation = sqrt(max(color * (1.0 - color), 0.0));
    // Light can't go below 0 nor above 1. Both tails are cut at the nearer end, so the mean stays; outside 0..1 there
    // is no room, and the light passes as it is.
    vec3 room = max(min(color, 1.0 - color), 0.0);
    return color + clamp(deviation * noise, -room, room);
}
