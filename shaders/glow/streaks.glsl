#include "lib/bright.glsl"
#include "lib/shrinking.glsl"

vec4 streaks_light(vec4 image, float threshold, float knee, float limit) {
    return bright_light(image, threshold, knee, limit);
}

vec4 streaks_shrink(int factor) { return shrunk(factor); }

// The mean of four samples, each `fade` times the weight of the one before. The next pass has four times the stride and
// fade^4. Each number has exactly one representation in base 4, so P passes give the geometric series of 4^P samples.
vec4 streaks_pass(vec2 stride, vec3 fade) {
    vec3 sum = vec3(0.0), total = vec3(0.0), weight = vec3(1.0);
    for (int i = 0; i < 4; ++i) {
        sum += weight * image_near(vec2(pixel) + 0.5 + float(i) * stride).rgb;
        total += weight;
        weight *= fade;
    }
    return vec4(sum / total, 1.0);
}

vec4 streaks_add(vec4 star, vec4 arm) { return star + arm; }

vec4 streaks_enlarge(int factor) { return enlarged(factor); }

vec4 streaks_glow(vec4 image, vec4 star, float share, vec4 tint) {
    return glow_alone(image, star.rgb * share * tint.rgb);
}

vec4 streaks(vec4 image, vec4 glow, float intensity) { return with_glow(image, intensity * glow.rgb); }
