#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

float levels_bend(float level, float gamma) { return level > 0.0 ? pow(level, 1.0 / max(gamma, 0.01)) : level; }

vec4 levels(
    vec4 image, int space, float black, float white, float gamma, float low, float high, bool clip
) {
    vec4 color = straight(finite(image));
    black = finite(black), white = finite(white), gamma = finite(gamma), low = finite(low), high = finite(high);
    float span = white - black;
    span = abs(span) < 1e-6 ? 1e-6 : span;  // equal ends: a step
    // Transparent pixels stay black.
    float covered = color.a > ALPHA_NONE ? 1.0 : 0.0;
    vec3 code = space == SPACE_DISPLAY ? srgb_encode(color.rgb) : color.rgb;
    vec3 level = (code - covered * black) / span;
    if (clip) level = clamp(level, 0.0, 1.0);
    level = vec3(levels_bend(level.r, gamma), levels_bend(level.g, gamma), levels_bend(level.b, gamma));
    code = level * (high - low) + covered * low;
    color.rgb = finite(space == SPACE_DISPLAY ? srgb_decode(code) : code);
    return finite(premultiplied(color));
}
