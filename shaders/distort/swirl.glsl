#include "lib/finite.glsl"
#include "lib/footprint.glsl"

// Where a pixel reads: the swirl turns light by `angle`, so the pixel turns back.
vec2 swirl_source(vec2 at, float angle, float radius, vec2 center) {
    vec2 away = at - center;
    float turn = -angle * exp(-dot(away, away) / (radius * radius));
    return center + mat2(cos(turn), sin(turn), -sin(turn), cos(turn)) * away;
}

vec4 swirl(float angle, float radius, vec2 center) {
    vec2 at = vec2(pixel) + 0.5, right = vec2(0.5, 0.0), down = right.yx;
    int n = footprint_samples(
        swirl_source(at + right, angle, radius, center) - swirl_source(at - right, angle, radius, center),
        swirl_source(at + down, angle, radius, center) - swirl_source(at - down, angle, radius, center)
    );
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i) sum += image_near(swirl_source(at + footprint_at(i, n), angle, radius, center));
    return finite(sum / float(n * n));
}
