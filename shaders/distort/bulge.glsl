#include "lib/finite.glsl"
#include "lib/footprint.glsl"

vec2 bulge_source(vec2 at, float strength, float radius, vec2 center) {
    vec2 away = at - center;
    float within = max(1.0 - dot(away, away) / (radius * radius), 0.0);
    return center + away * (1.0 - strength * within * within);
}

vec4 bulge(float strength, float radius, vec2 center) {
    vec2 at = vec2(pixel) + 0.5, right = vec2(0.5, 0.0), down = right.yx;
    int n = footprint_samples(
        bulge_source(at + right, strength, radius, center) - bulge_source(at - right, strength, radius, center),
        bulge_source(at + down, strength, radius, center) - bulge_source(at - down, strength, radius, center)
    );
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i) sum += image_near(bulge_source(at + footprint_at(i, n), strength, radius, center));
    return finite(sum / float(n * n));
}
