#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/curve.glsl"
#include "lib/finite.glsl"

const float GRADIENT_MAP_DARKEST = 1e-5;  // least luminance: 0 has no logarithm

float gradient_map_scaled(float light, int scale) {
    if (scale == SCALE_STOPS) return log2(max(light, GRADIENT_MAP_DARKEST));
    return scale == SCALE_DISPLAY ? srgb_encode(light) : light;
}

vec4 gradient_map(
    vec4 image, const vec4 ramp[34], int scale, float low, float high, bool reverse, bool smoothed, float amount
) {
    image = finite(image);
    vec4 color = straight(image);
    float first = gradient_map_scaled(low, scale), span = gradient_map_scaled(high, scale) - first;
    span = abs(span) < 1e-6 ? 1e-6 : span;  // equal ends: a step
    float t = clamp((gradient_map_scaled(luminance(color.rgb), scale) - first) / span, 0.0, 1.0);
    vec4 painted = ramp_at(ramp, reverse ? 1.0 - t : t, smoothed);
    float alpha = painted.a * color.a;
    return mix(image, vec4(painted.rgb * alpha, alpha), amount);
}
