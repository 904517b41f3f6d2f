#include "viewer/sample.glsl"
#include "viewer/palette.glsl"
#include "viewer/view.glsl"

// One panel of the viewer with pictures a and b. Rows run downward, as in pictures. DATA, VIEWED, COMPARE and the names
// of modes are defined before this file, and so is view_transform() where it is needed.

uniform sampler2D a;
uniform vec2 a_origin, a_step;
uniform int a_channels;
uniform ivec4 a_part;
#if COMPARE != COMPARE_OFF
uniform sampler2D b;
uniform vec2 b_origin, b_step;
uniform int b_channels;
uniform ivec4 b_part;
#endif

#if VIEWED
uniform sampler2D viewed;  // picture a by texels, with the view applied
uniform ivec2 viewed_first;
#endif

uniform int meaning;
uniform vec2 range;
uniform vec2 wipe_point, wipe_normal;
uniform bool checker, clipping, nonfinite;
uniform vec3 background, surround;
uniform vec4 region;

out vec4 result;

vec3 behind(vec2 at) {
    if (!checker) return background;
    ivec2 square = ivec2(at) >> 3;
    return vec3(((square.x ^ square.y) & 1) == 0 ? 0.30 : 0.42);
}

#if DATA
// Data has no color, so no view is applied.
vec3 looked_at(vec4 c, vec2 at) {
    if (meaning == IMAGE) return channels == ALPHA ? vec3(c.a) : false_color(luminance(c.rgb));
    return chosen(meaning == NORMAL ? c * 0.5 + 0.5 : (c - range.x) / (range.y - range.x));
}
#else
vec3 looked_at(vec4 c, vec2 at) {
    bool opaque = channels != COLOR || c.a >= 1.0;
#if VIEWED
    vec3 shown = texelFetch(viewed, ivec2(floor((at - a_origin) * a_step)) - viewed_first, 0).rgb;
#else
    vec3 shown = seen(c);
#endif
    return opaque ? shown : shown * min(straightness(c), 1.0) + behind(at) * (1.0 - max(c.a, 0.0));
}
#endif

vec3 warned(vec3 shown, Sampled texel, vec2 at) {
    if (nonfinite && texel.broken) return vec3(1.0, 0.0, 1.0);
    if (!clipping || fract((at.x + at.y) / 8.0) >= 0.5) return shown;
    vec3 c = meaning == IMAGE ? chosen(texel.value)
        : meaning == NORMAL ? texel.value.rgb * 0.5 + 0.5 : (texel.value.rgb - range.x) / (range.y - range.x);
    if (largest(c) > 1.0) return vec3(1.0, 0.15, 0.1);
    return smallest(c) < 0.0 ? vec3(0.1, 0.35, 1.0) : shown;
}

void main() {
    vec2 at = gl_FragCoord.xy;
    Sampled texel = sampled(a, a_part, a_origin, a_step, a_channels, at);
    bool dimmed = beyond_frame(a_part, a_origin, a_step, at);
#if COMPARE == COMPARE_WIPE
    float across = dot(at - wipe_point, wipe_normal);
    if (across > 0.0) {
        texel = sampled(b, b_part, b_origin, b_step, b_channels, at);
        dimmed = beyond_frame(b_part, b_origin, b_step, at);
    }
#elif COMPARE == COMPARE_DIFFERENCE
    Sampled other = sampled(b, b_part, b_origin, b_step, b_channels, at);
    texel.value = vec4(abs(texel.value.rgb - other.value.rgb), channels == ALPHA ? abs(texel.value.a - other.value.a) : 1.0);
    texel.broken = texel.broken || other.broken;
    texel.inside = texel.inside || other.inside;
    dimmed = dimmed && beyond_frame(b_part, b_origin, b_step, at);
#endif
    if (meaning == IMAGE) texel.value.rgb *= exposure;
    vec3 shown = looked_at(texel.value, at);
    shown = warned(shown, texel, at);
    if (dimmed || any(lessThan(at, region.xy)) || any(greaterThan(at, region.zw))) shown *= 0.35;
    if (!texel.inside) shown = surround;
#if COMPARE == COMPARE_WIPE
    if (abs(across) < 0.5) shown = vec3(1.0);
#endif
    result = vec4(shown, 1.0);
}
