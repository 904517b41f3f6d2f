#include "lib/id_color.glsl"

float cryptomatte_nothing() { return 0.0; }

// Adds the coverage of the chosen ids. A picture holds two ranks: an id and its coverage, twice. Ids are compared bit
// by bit (Cryptomatte specification 1.2).
float cryptomatte_covered(float coverage, vec4 ranks, vec4 ids[16], int count) {
    uvec2 ours = floatBitsToUint(ranks.xz);
    for (int i = 0; i < count; ++i) {
        vec2 halves = i % 2 == 0 ? ids[i / 2].xy : ids[i / 2].zw;
        uint id = uint(halves.x) << 16 | uint(halves.y);
        if (ours.x == id) coverage += finite(ranks.y);
        if (ours.y == id) coverage += finite(ranks.w);
    }
    return coverage;
}

float cryptomatte_anything(float coverage, vec4 ranks) {
    return coverage + (ranks.x != 0.0 ? finite(ranks.y) : 0.0) + (ranks.z != 0.0 ? finite(ranks.w) : 0.0);
}

float cryptomatte(float coverage, bool invert) { return invert ? 1.0 - coverage : coverage; }

vec4 cryptomatte_no_colors() { return vec4(0.0); }

vec4 cryptomatte_mixed(vec4 colors, vec4 ranks) {
    vec4 safe = finite(ranks);
    if (safe.x != 0.0) colors += safe.y * vec4(id_color(safe.x), 1.0);
    if (safe.z != 0.0) colors += safe.w * vec4(id_color(safe.z), 1.0);
    return colors;
}

vec4 cryptomatte_colors(vec4 colors) { return colors; }
