#include "lib/bright.glsl"
#include "lib/shrinking.glsl"

vec4 sun_beams_light(
    vec4 image, float mask, vec2 source, float radius, float threshold, float knee, float limit
) {
    float far = length(vec2(pixel) + 0.5 - source * vec2(extent));
    float near = radius > 0.0 ? 1.0 - smoothstep(radius, 2.0 * radius, far) : 0.0;
    return bright_light(image, threshold, knee, limit) * near * clamp(finite(mask), 0.0, 1.0);
}

vec4 sun_beams_shrink(int factor) { return shrunk(factor); }

// The mean of four samples, each `shrink` times as far from the source as the one before, with `fade` times its weight.
vec4 sun_beams_pass(vec2 source, float shrink, float fade) {
    vec2 away = vec2(pixel) + 0.5 - source;
    vec4 sum = vec4(0.0);
    float total = 0.0, weight = 1.0;
    for (int i = 0; i < 4; ++i) {
        sum += weight * image_near(source + away);
        total += weight;
        weight *= fade;
        away *= shrink;
    }
    return sum / total;
}

vec4 sun_beams_enlarge(int factor) { return enlarged(factor); }

vec4 sun_beams_glow(vec4 image, vec4 beams, vec4 tint) { return glow_alone(image, beams.rgb * tint.rgb); }

vec4 sun_beams(vec4 image, vec4 glow, float intensity) { return with_glow(image, intensity * glow.rgb); }
