#include "lib/alpha.glsl"
#include "lib/blending.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

float merge_channel(int mode, float b, float a) {
    if (mode == MODE_MULTIPLY) return b * a;
    if (mode == MODE_SCREEN) return blend_screen(b, a);
    if (mode == MODE_OVERLAY) return blend_hard_light(a, b);
    if (mode == MODE_SOFT_LIGHT) return blend_soft_light(b, a);
    if (mode == MODE_HARD_LIGHT) return blend_hard_light(b, a);
    if (mode == MODE_COLOR_DODGE) return blend_color_dodge(b, a);
    if (mode == MODE_COLOR_BURN) return blend_color_burn(b, a);
    if (mode == MODE_DARKEN) return min(b, a);
    if (mode == MODE_LIGHTEN) return max(b, a);
    if (mode == MODE_DIFFERENCE) return abs(b - a);
    if (mode == MODE_EXCLUSION) return b + a - 2.0 * b * a;
    if (mode == MODE_SUBTRACT) return b - a;
    if (mode == MODE_DIVIDE) return a > 0.0 ? b / a : 0.0;
    if (mode == MODE_HYPOT) return length(vec2(b, a));
    return 0.5 * (b + a);  // average
}

// The four blends of whole colors, with the luminance of the working space (the W3C uses the weights 0.3, 0.59, 0.11).

vec3 merge_with_luminance(vec3 c, float target, float ceiling) {
    c += target - luminance(c);
    float low = smallest(c), high = largest(c);
    if (low < 0.0) c = target + (c - target) * target / max(target - low, 1e-9);
    if (high > ceiling) c = target + (c - target) * (ceiling - target) / max(high - target, 1e-9);
    return c;
}

float merge_spread(vec3 c) { return largest(c) - smallest(c); }

vec3 merge_with_saturation(vec3 c, float spread) {
    return (c - smallest(c)) * spread / max(merge_spread(c), 1e-9);
}

vec3 merge_color(int mode, vec3 b, vec3 a) {
    float ceiling = max(1.0, max(largest(b), largest(a)));  // above 1, no brighter than the inputs
    float level = luminance(b);
    if (mode == MODE_HUE) return merge_with_luminance(merge_with_saturation(a, merge_spread(b)), level, ceiling);
    if (mode == MODE_SATURATION) return merge_with_luminance(merge_with_saturation(b, merge_spread(a)), level, ceiling);
    if (mode == MODE_COLOR) return merge_with_luminance(a, level, ceiling);
    return merge_with_luminance(b, luminance(a), ceiling);  // luminosity
}

// `beyond` is how much of `a` shows where `b` does not cover.
vec4 merge_blend(int mode, vec4 a, vec4 b, float beyond) {
    vec3 above = max(straight(a).rgb, 0.0), below = max(straight(b).rgb, 0.0);
    vec3 both = mode >= MODE_HUE ? merge_color(mode, below, above) : vec3(
        merge_channel(mode, below.r, above.r), merge_channel(mode, below.g, above.g),
        merge_channel(mode, below.b, above.b)
    );
    vec3 rgb = a.rgb * beyond + b.rgb * (1.0 - a.a) + a.a * b.a * both;
    return vec4(rgb, a.a + b.a - a.a * b.a);
}

// Clipped is what an opaque `b` gives, times its alpha. Written so that light where alpha is 0 stays.
vec4 merge(vec4 a, vec4 b, float mask, int mode, float amount, bool clipped) {
    a = finite(a), b = finite(b);
    float beyond = clipped ? 0.0 : 1.0 - b.a;
    vec4 front = clipped ? a * b.a : a;
    vec4 merged = vec4(0.0);  // the mode clear
    if (mode == MODE_OVER) merged = front + b * (1.0 - a.a);
    if (mode == MODE_UNDER) merged = b + a * beyond;
    if (mode == MODE_IN) merged = a * b.a;
    if (mode == MODE_OUT) merged = a * beyond;
    if (mode == MODE_ATOP) merged = a * b.a + b * (1.0 - a.a);
    if (mode == MODE_XOR) merged = a * beyond + b * (1.0 - a.a);
    if (mode == MODE_PLUS) merged = vec4(front.rgb + b.rgb, min(a.a + b.a, 1.0));
    if (mode >= MODE_MULTIPLY) merged = merge_blend(mode, a, b, beyond);
    if (clipped && (mode == MODE_PLUS || mode >= MODE_MULTIPLY)) merged.a = b.a;
    return finite(mix(b, merged, finite(mask) * finite(amount)));
}
