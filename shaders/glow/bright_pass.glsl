#include "lib/bright.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

vec4 bright_pass(
    vec4 image, float mask, int mode, int measure, float threshold, float knee, float power, float limit
) {
    vec4 safe = finite(image);
    float light = finite(measure == MEASURE_MAXIMUM ? largest(safe.rgb) : luminance(safe.rgb));
    if (light <= 0.0) return vec4(0.0, 0.0, 0.0, safe.a);
    float bounded = min(light, max(finite(limit), 0.0)), kept = bounded;
    threshold = max(finite(threshold), 0.0);
    if (mode == MODE_HARD) kept = bright_hard(bounded, threshold);
    if (mode == MODE_SOFT) kept = bright_soft(bounded, threshold, clamp(finite(knee), 0.0, 1.0));
    if (mode == MODE_EXPONENTIAL) kept = bright_exponential(bounded, threshold, max(finite(power), 0.0));
    if (mode == MODE_POWER) kept = bright_power(bounded, threshold, max(finite(power), 0.0));
    float share = kept / light * clamp(finite(mask), 0.0, 1.0);
    // A power may exceed the range of half floats.
    return vec4(clamp(finite(safe.rgb * finite(share)), -65504.0, 65504.0), safe.a);
}
