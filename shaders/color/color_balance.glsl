#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

// How much a tone belongs to the shadows, the midtones and the highlights; the sum is 1.
vec3 color_balance_ranges(float tone, float low, float high, float blend) {
    float half_width = max(0.5 * blend, 1e-4);
    float above = smoothstep(low - half_width, low + half_width, tone);
    float top = smoothstep(high - half_width, high + half_width, tone);
    return vec3(1.0 - above, above * (1.0 - top), above * top);
}

vec3 color_balance_graded(vec3 rgb, vec3 lift, vec3 gamma, vec3 gain) {
    vec3 code = max((1.0 + (srgb_encode(rgb) - 1.0) * (2.0 - lift)) * gain, 0.0);
    return pow(max(srgb_decode(code), 0.0), 1.0 / max(gamma, 1e-4));
}

vec4 color_balance(
    vec4 image, vec4 lift, vec4 gamma, vec4 gain, float shadows, float midtones, float highlights, float low, float high,
    float blend, int show
) {
    vec4 c = straight(finite(image));
    float tone = srgb_encode(max(luminance(c.rgb), 0.0));
    vec3 ranges = color_balance_ranges(tone, finite(low), finite(high), finite(blend));
    if (show == SHOW_RANGES) return premultiplied(vec4(ranges, c.a));
    vec3 graded = color_balance_graded(c.rgb, finite(lift.rgb), finite(gamma.rgb), finite(gain.rgb));
    // A lift makes light of black: transparent pixels stay black.
    if (c.a <= ALPHA_NONE) graded -= color_balance_graded(vec3(0.0), finite(lift.rgb), finite(gamma.rgb), finite(gain.rgb));
    float amount = dot(ranges, clamp(finite(vec3(shadows, midtones, highlights)), 0.0, 1.0));
    return finite(premultiplied(vec4(mix(c.rgb, graded, amount), c.a)));
}
