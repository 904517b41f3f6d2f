#include "lib/finite.glsl"

// From one level to the next. Variances mix evenly, sigmas do not.
vec4 variable_blur(vec4 sharp, vec4 soft, float field, float low, float high) {
    float sigma = clamp(finite(field), 0.0, 1.0);
    float share = (sigma * sigma - low * low) / (high * high - low * low);
    return share <= 0.0 ? finite(sharp) : share >= 1.0 ? soft : mix(finite(sharp), soft, share);
}
