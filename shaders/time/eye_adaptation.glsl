#include "lib/adaptation.glsl"
#include "lib/color.glsl"

const float eye_adaptation_dark = 1e-5;   // least luminance: 0 has no logarithm
const float eye_adaptation_most = 1e9;    // brighter than any light
const float eye_adaptation_cones = 0.1, eye_adaptation_rods = 0.4;  // time constants in seconds (Krawczyk et al. 2005)

// The terms of the sums: the logarithm of light, and the weight of the pixel.
vec2 eye_adaptation_terms(vec4 image) {
    vec4 light = metered(image);
    return light.a * vec2(log(luminance(light.rgb) + eye_adaptation_dark), 1.0);
}

float eye_adaptation_average(vec2 sums) { return sums.y > 0.0 ? exp(sums.x / sums.y) : eye_adaptation_dark; }

float eye_adaptation_given(float luminance) {
    return clamp(finite(luminance), eye_adaptation_dark, eye_adaptation_most);
}

float eye_adaptation_follow(float seen, float before, float passed, int model, vec2 times, int scale, float nits) {
    float rods = 0.04 / (0.04 + seen * nits);  // their share at a luminance in cd/m2 (Krawczyk et al. 2005)
    float time = mix(eye_adaptation_cones, eye_adaptation_rods, rods);
    if (model == MODEL_CUSTOM) time = seen > before ? times.x : times.y;
    float kept = time > 0.0 ? exp(-passed / time) : 0.0;
    if (scale == SCALE_STOPS) return seen * pow(before / seen, kept);
    return mix(seen, before, kept);
}

float eye_adaptation_stops(
    float adapted, float key, bool natural, float nits, float minimum, float maximum, float compensation
) {
    if (natural) key = natural_key(adapted * nits);
    return clamp(log2(key / adapted), minimum, maximum) + compensation;
}

vec4 eye_adaptation(vec4 image, float exposure) { return finite(vec4(finite(image.rgb) * exp2(exposure), image.a)); }
