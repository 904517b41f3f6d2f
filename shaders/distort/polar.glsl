#include "lib/finite.glsl"
#include "lib/footprint.glsl"
#include "lib/pi.glsl"

// Angle as a part of a turn, and distance as a part of the radius.
vec2 polar_of(vec2 at, float radius, float rotation, vec2 center) {
    vec2 away = at - center;
    float far = length(away), angle = far > 0.0 ? atan(away.y, away.x) - rotation : 0.0;
    return vec2(fract(angle / (2.0 * PI)), far / radius);
}

// Wraps the picture around the center: its left and right sides join, its bottom is the rim.
vec4 polar_wrap(float radius, float rotation, vec2 center, bool empty) {
    vec2 at = vec2(pixel) + 0.5, size = vec2(image_size);
    float far = max(distance(at, center), 0.5);
    // The part of the circle and of the radius that a pixel spans. Differences would be wrong at the seam.
    int n = footprint_samples(vec2(size.x / (2.0 * PI * far), 0.0), vec2(0.0, size.y / radius));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i) {
        vec2 place = polar_of(at + footprint_at(i, n), radius, rotation, center);
        if (empty && place.y > 1.0) continue;
        place *= size;
        sum += image_near(vec2(place.x, clamp(place.y, 0.5, size.y - 0.5)));
    }
    return finite(sum / float(n * n));
}

vec4 polar_unwrap(float radius, float rotation, vec2 center) {
    vec2 at = vec2(pixel) + 0.5, size = vec2(extent);
    float turn = 2.0 * PI / size.x, ring = radius / size.y;
    int n = footprint_samples(vec2(turn * at.y * ring, 0.0), vec2(0.0, ring));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i) {
        vec2 from = at + footprint_at(i, n);
        float angle = from.x * turn + rotation;
        sum += image_near(center + from.y * ring * vec2(cos(angle), sin(angle)));
    }
    return finite(sum / float(n * n));
}
