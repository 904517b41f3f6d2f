#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

const float luminance_statistics_none = -3.4e38;  // below every luminance: means that no pixel counts

// The luminance of a pixel, and its weight.
vec2 luminance_statistics_light(vec4 image, bool alpha_weighted) {
    if (!is_finite(image) || (alpha_weighted && image.a <= ALPHA_NONE)) return vec2(0.0);
    return alpha_weighted ? vec2(luminance(straight(image).rgb), image.a) : vec2(luminance(image.rgb), 1.0);
}

// The terms of the sums: light, its logarithm, and the count.
vec3 luminance_statistics_terms(vec4 image, float delta, bool alpha_weighted) {
    vec2 light = luminance_statistics_light(image, alpha_weighted);
    return light.y * vec3(light.x, log(max(light.x, 0.0) + delta), 1.0);
}

// The terms of the maxima: light and its negative.
vec2 luminance_statistics_ends(vec4 image, bool alpha_weighted) {
    vec2 light = luminance_statistics_light(image, alpha_weighted);
    return light.y > 0.0 ? vec2(light.x, -light.x) : vec2(luminance_statistics_none);
}

float luminance_statistics_average(vec3 sums) { return sums.z > 0.0 ? sums.x / sums.z : 0.0; }

float luminance_statistics_log_average(vec3 sums) { return sums.z > 0.0 ? exp(sums.y / sums.z) : 0.0; }

float luminance_statistics_maximum(vec2 ends) { return ends.x > luminance_statistics_none ? ends.x : 0.0; }

float luminance_statistics_minimum(vec2 ends) { return ends.y > luminance_statistics_none ? -ends.y : 0.0; }
