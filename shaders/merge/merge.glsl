#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

// Blend modes of one channel (W3C Compositing and Blending 1): b is the background, a the foreground, both straight and
// not negative. The W3C defines them for 0..1; here they continue for brighter light without a jump.

// Screen is not defined above 1: there the brighter one wins, as in Nuke.
float merge_screen(float b, float a) { return max(a, b) > 1.0 ? max(a, b) : a + b - a * b; }

float merge_hard_light(float b, float a) { return a <= 0.5 ? 2.0 * a * b : merge_screen(b, 2.0 * a - 1.0); }

// A background of 1 or more stays; the foreground counts up to 1.
float merge_soft_light(float b, float a) {
    a = min(a, 1.0);
    if (b >= 1.0) return b;
    if (a <= 0.5) return b - (1.0 - 2.0 * a) * b * (1.0 - b);
    float lighter = b <= 0.25 ? ((16.0 * b - 12.0) * b + 4.0) * b : sqrt(b);
    return b + (2.0 * a - 1.0) * (lighter - b);
}

// Limited to 1, or to the background if that is brighter.
float merge_color_dodge(float b, float a) {
    if (b == 0.0) return 0.0;
    return a >= 1.0 ? max(b, 1.0) : min(max(b, 1.0), b / (1.0 - a));
}

// A background of 1 or more stays.
float merge_color_burn(float b, float a) {
    if (b >= 1.0) return b;
    return a <= 0.0 ? 0.0 : 1.0 - min(1.0, (1.0 - b) / a);
}

float merge_channel(int mode, float b, float a) {
    if (mode == MODE_MULTIPLY) return b * a;
    if (mode == MODE_SCREEN) return merge_screen(b, a);
    if (mode == MODE_OVERLAY) return merge_hard_light(a, b);
    if (mode == MODE_SOFT_LIGHT) return merge_soft_light(b, a);
    if (mode == MODE_HARD_LIGHT) return merge_hard_light(b, a);
    if (mode == MODE_COLOR_DODGE) return merge_color_dodge(b, a);
    if (mode == MODE_COLOR_BURN) return merge_color_burn(b, a);
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

vec3 merge_with_luminance(vec3 c, float wanted, float ceiling) {
    c += wanted - luminance(c);
    float low = smallest(c), high = largest(c);
    if (low < 0.0) c = wanted + (c - wanted) * wanted / max(wanted - low, 1e-9);
    if (high > ceiling) c = wanted + (c - wanted) * (ceiling - wanted) / max(high - wanted, 1e-9);
    return c;
}

float merge_spread(vec3 c) { return largest(c) - smallest(c); }

vec3 merge_with_saturation(vec3 c, float wanted) {
    return (c - smallest(c)) * wanted / max(merge_spread(c), 1e-9);
}

vec3 merge_color(int mode, vec3 b, vec3 a) {
    float ceiling = max(1.0, max(largest(b), largest(a)));  // above 1, no brighter than the inputs
    float level = luminance(b);
    if (mode == MODE_HUE) return merge_with_luminance(merge_with_saturation(a, merge_spread(b)), level, ceiling);
    if (mode == MODE_SATURATION) return merge_with_luminance(merge_with_saturation(b, merge_spread(a)), level, ceiling);
    if (mode == MODE_COLOR) return merge_with_luminance(a, level, ceiling);
    return merge_with_luminance(b, luminance(a), ceiling);  // luminosity
}

vec4 merge_blend(int mode, vec4 a, vec4 b) {
    vec3 above = max(straight(a).rgb, 0.0), below = max(straight(b).rgb, 0.0);
    vec3 both = mode >= MODE_HUE ? merge_color(mode, below, above) : vec3(
        merge_channel(mode, below.r, above.r), merge_channel(mode, below.g, above.g),
        merge_channel(mode, below.b, above.b)
    );
    vec3 rgb = a.rgb * (1.0 - b.a) + b.rgb * (1.0 - a.a) + a.a * b.a * both;
    return vec4(rgb, a.a + b.a - a.a * b.a);
}

vec4 merge(vec4 a, vec4 b, float mask, int mode, float amount) {
    a = finite(a), b = finite(b);
    vec4 merged = vec4(0.0);  // the mode clear
    if (mode == MODE_OVER) merged = a + b * (1.0 - a.a);
    if (mode == MODE_UNDER) merged = b + a * (1.0 - b.a);
    if (mode == MODE_IN) merged = a * b.a;
    if (mode == MODE_OUT) merged = a * (1.0 - b.a);
    if (mode == MODE_ATOP) merged = a * b.a + b * (1.0 - a.a);
    if (mode == MODE_XOR) merged = a * (1.0 - b.a) + b * (1.0 - a.a);
    if (mode == MODE_PLUS) merged = vec4(a.rgb + b.rgb, min(a.a + b.a, 1.0));
    if (mode >= MODE_MULTIPLY) merged = merge_blend(mode, a, b);
    return finite(mix(b, merged, finite(mask) * finite(amount)));
}
