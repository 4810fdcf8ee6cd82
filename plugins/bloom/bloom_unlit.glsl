#include <postfx/census.glsl>

vec2 bloom_unlit(Census source, BloomUnlitParams params) {
    return vec2(max(source.highest.r, max(source.highest.g, source.highest.b)), params.dark);
}
