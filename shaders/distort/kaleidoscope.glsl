#include "lib/finite.glsl"
#include "lib/footprint.glsl"
#include "lib/pi.glsl"

// Where a pixel reads. `tube` holds the rotation, the angle of the slice that is repeated, and the zoom.
vec2 kaleidoscope_source(vec2 at, int segments, vec2 center, vec3 tube) {
    vec2 away = at - center;
    float far = length(away), wedge = 2.0 * PI / float(segments);
    float angle = far > 0.0 ? atan(away.y, away.x) - tube.x : 0.0;
    angle -= wedge * floor(angle / wedge);
    angle = min(angle, wedge - angle) + tube.y;  // every second wedge is mirrored
    return center + far / tube.z * vec2(cos(angle), sin(angle));
}

vec4 kaleidoscope(int segments, vec2 center, vec3 tube) {
    vec2 at = vec2(pixel) + 0.5, right = vec2(0.5, 0.0), down = right.yx;
    int n = footprint_samples(
        kaleidoscope_source(at + right, segments, center, tube) - kaleidoscope_source(at - right, segments, center, tube),
        kaleidoscope_source(at + down, segments, center, tube) - kaleidoscope_source(at - down, segments, center, tube)
    );
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i)
        sum += image_near(kaleidoscope_source(at + footprint_at(i, n), segments, center, tube));
    return finite(sum / float(n * n));
}
