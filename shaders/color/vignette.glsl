#include "lib/finite.glsl"

vec4 vignette(vec4 image, int falloff, float amount, float radius, float softness, float roundness, vec2 center) {
    vec2 half_size = 0.5 * vec2(extent);
    // The circle has the root mean square of the half width and half height as its radius, so that corners lie at 1.41
    // for the circle and for the ellipse.
    vec2 unit = mix(half_size, vec2(length(half_size) * 0.70710678), finite(roundness));
    float off_axis = length((vec2(pixel) + 0.5 - center * vec2(extent)) / max(unit, vec2(1e-3)));
    float loss = 0.0;
    if (falloff == FALLOFF_SMOOTH) {
        float inner = radius * (1.0 - softness), outer = radius * (1.0 + softness);
        loss = smoothstep(inner, max(outer, inner + 1e-4), off_axis);
    }
    if (falloff == FALLOFF_COS4) {
        float slope = off_axis / max(radius, 1e-3), cos2 = 1.0 / (1.0 + slope * slope);
        loss = 1.0 - cos2 * cos2;
    }
    return finite(vec4(image.rgb * (1.0 - finite(amount) * finite(loss)), image.a));
}
