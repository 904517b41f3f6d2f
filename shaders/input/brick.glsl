#include "lib/finite.glsl"
#include "lib/hash.glsl"

// How much brick lies between 0 and `at`, along an axis with bricks that are `period` apart, between joints.
float brick_sum(float at, float period, float mortar) {
    float whole = floor(at / period);
    return whole * (period - mortar) + clamp(at - whole * period - 0.5 * mortar, 0.0, period - mortar);
}

float brick_share(float at, float period, float mortar) {
    return brick_sum(at + 0.5, period, mortar) - brick_sum(at - 0.5, period, mortar);
}

// The number of a row, and how far it is shifted.
float brick_shift(float row, float width, float shift, int every) {
    return mod(row, float(max(every, 1))) >= float(max(every, 1) - 1) && every > 1 ? shift * width : 0.0;
}

void brick(
    float width, float height, float mortar, float shift, int every, vec4 first, vec4 second, vec4 joint, float variety,
    int seed, vec2 offset, out vec4 result, out float value, out float random
) {
    vec2 size = max(finite(vec2(width, height)), 1e-2), at = vec2(pixel) + 0.5 - finite(offset);
    float gap = max(finite(mortar), 0.0), row = floor(at.y / size.y);
    vec2 gaps = min(vec2(gap), size);
    value = 0.0;
    // A pixel lies in two rows at most, where a row is higher than a pixel; lower rows are averaged.
    float low = floor((at.y - 0.5) / size.y), high = floor((at.y + 0.5) / size.y);
    for (int i = 0; i < 2; ++i) {
        float here = i == 0 ? low : high, top = max(at.y - 0.5, here * size.y);
        float bottom = i == 0 && high > low ? high * size.y : at.y + 0.5;
        if (i == 1 && high == low) break;
        float down = brick_sum(bottom, size.y, gaps.y) - brick_sum(top, size.y, gaps.y);
        float across = brick_share(at.x - brick_shift(here, size.x, finite(shift), every), size.x, gaps.x);
        value += down * across;
    }
    value = clamp(finite(value), 0.0, 1.0);
    float column = floor((at.x - brick_shift(row, size.x, finite(shift), every)) / size.x);
    vec2 cell = clamp(vec2(column, row), -1e9, 1e9);
    random = hash3(ivec3(ivec2(cell), 0), pcg3d(uvec3(uint(seed), 0u, 0u))).x;
    vec4 color = mix(finite(first), finite(second), 0.5 + (random - 0.5) * clamp(finite(variety), 0.0, 1.0));
    result = mix(finite(joint), color, value);
}
