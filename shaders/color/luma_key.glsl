#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

float luma_key_light(vec3 rgb, int measure) {
    if (measure == MEASURE_MAXIMUM) return largest(rgb);
    if (measure == MEASURE_MINIMUM) return smallest(rgb);
    if (measure == MEASURE_SATURATION) return largest(rgb) > 0.0 ? 1.0 - smallest(rgb) / largest(rgb) : 0.0;
    return luminance(rgb);
}

// 1 where `inside` is at least 0, and a ramp down to 0 at -softness.
float luma_key_ramp(float inside, float softness) {
    return inside >= 0.0 ? 1.0 : clamp(1.0 + inside / max(softness, 1e-9), 0.0, 1.0);
}

void luma_key(
    vec4 image, int measure, float low, float high, float low_softness, float high_softness, bool invert,
    out vec4 result, out float matte
) {
    image = finite(image);
    float light = finite(luma_key_light(straight(image).rgb, measure));
    float kept = luma_key_ramp(light - finite(low), finite(low_softness))
               * luma_key_ramp(finite(high) - light, finite(high_softness));
    kept = invert ? 1.0 - kept : kept;
    result = image * kept;
    matte = clamp(image.a, 0.0, 1.0) * kept;
}
