// Gray morphology: the largest or the smallest of the pixels around one, found from `spans` of 1, 2, 4, ... pixels in a
// row. Two of these, which overlap, cover any length.
#include "lib/finite.glsl"

// The larger number for sense 1, the smaller one for sense -1.
vec4 morphology_extreme(vec4 a, vec4 b, float sense) { return sense > 0.0 ? max(a, b) : min(a, b); }

// The extremes of `count` pixels here and of as many behind them, along an axis.
vec4 morphology_double(int axis, int count, float sense) {
    ivec2 behind = pixel;
    behind[axis] += count;
    return morphology_extreme(finite(spans_at(pixel)), finite(spans_at(behind)), sense);
}

// The extremes of `total` pixels from `start` on: of the first and the last `count` of them, which overlap.
vec4 morphology_join(int axis, int start, int count, int total, float sense) {
    ivec2 first = pixel, last = pixel;
    first[axis] += start;
    last[axis] += start + total - count;
    return morphology_extreme(finite(spans_at(first)), finite(spans_at(last)), sense);
}

// The extremes of `grown` and of the rows from `first` to `last`, above and below the center of a disc.
vec4 morphology_disc(int first, int last, int margin, int radius, int count, float sense) {
    vec4 extreme = finite(grown_at(pixel));
    for (int row = first; row <= last; ++row) {
        int width = int(floor(sqrt(float(radius * radius - row * row) + 0.5)));
        for (int side = -1; side <= 1; side += 2) {
            ivec2 place = pixel + ivec2(margin - width, margin + side * row);
            extreme = morphology_extreme(extreme, finite(spans_at(place)), sense);
            place.x += 2 * width + 1 - count;
            extreme = morphology_extreme(extreme, finite(spans_at(place)), sense);
        }
    }
    return extreme;
}

// The extremes for a radius between two whole ones.
vec4 morphology_mix(vec4 smaller, vec4 larger, float part) { return mix(finite(smaller), finite(larger), part); }
