#include "lib/color.glsl"
#include "lib/finite.glsl"

const float histogram_none = -3.4e38;  // below every value: means that no pixel counts
const float histogram_linear = 1e-6;  // values below this are on a linear scale

// A scale on which halving a range finds dark values to as many digits as bright ones.
float histogram_encode(float x) { return sign(x) * (log2(abs(x) + histogram_linear) - log2(histogram_linear)); }
float histogram_decode(float code) {
    return sign(code) * (exp2(abs(code) + log2(histogram_linear)) - histogram_linear);
}

// The value of a pixel, and 1 where it counts.
vec2 histogram_light(vec4 image, int channel) {
    if (!is_finite(image)) return vec2(0.0);
    if (channel == CHANNEL_LUMINANCE) return vec2(luminance(image.rgb), 1.0);
    return vec2(image[channel - CHANNEL_RED], 1.0);
}

float histogram_mean(vec2 sums) { return sums.y > 0.0 ? finite(sums.x / sums.y) : 0.0; }

vec2 histogram_squares(vec2 light, float mean) {
    float away = clamp(light.x - mean, -1e15, 1e15);  // its square is a number still
    return light.y * vec2(away * away, 1.0);
}

float histogram_deviation(vec2 squares) { return squares.y > 0.0 ? sqrt(squares.x / squares.y) : 0.0; }

// The terms of the maxima: the value and its negative.
vec2 histogram_ends(vec2 light) { return light.y > 0.0 ? vec2(light.x, -light.x) : vec2(histogram_none); }

vec3 histogram_least(vec2 ends) { return vec3(ends.y > histogram_none ? histogram_encode(-ends.y) : 0.0); }
vec3 histogram_most(vec2 ends) { return vec3(ends.x > histogram_none ? histogram_encode(ends.x) : 0.0); }

vec3 histogram_between(vec3 below, vec3 above) { return 0.5 * (below + above); }

// How many pixels of a block are no brighter than the middles of three ranges.
vec3 histogram_count(int block) {
    vec3 code = histogram_between(below_at(ivec2(0)), above_at(ivec2(0)));
    vec3 middle = vec3(histogram_decode(code.x), histogram_decode(code.y), histogram_decode(code.z)), sum = vec3(0.0);
    ivec2 end = min((pixel + 1) * block, light_size);
    for (int y = pixel.y * block; y < end.y; ++y)
        for (int x = pixel.x * block; x < end.x; ++x) {
            vec2 measured = light_at(ivec2(x, y));
            sum += measured.y * vec3(lessThanEqual(vec3(measured.x), middle));
        }
    return sum;
}

// Whether enough pixels are no brighter than the middle of a range, so that the percentile is in its lower half. The
// factor keeps rounding from asking for one pixel more.
bvec3 histogram_enough(vec3 counts, vec2 sums, vec3 shares) {
    return greaterThanEqual(counts, max(ceil(shares * sums.y * (1.0 - 3e-7)), 1.0));
}

vec3 histogram_raise(vec3 below, vec3 above, vec3 counts, vec2 sums, vec3 shares) {
    return mix(histogram_between(below, above), below, histogram_enough(counts, sums, shares));
}

vec3 histogram_lower(vec3 below, vec3 above, vec3 counts, vec2 sums, vec3 shares) {
    return mix(above, histogram_between(below, above), histogram_enough(counts, sums, shares));
}

float histogram_low(vec3 places) { return histogram_decode(places.x); }
float histogram_middle(vec3 places) { return histogram_decode(places.y); }
float histogram_high(vec3 places) { return histogram_decode(places.z); }
