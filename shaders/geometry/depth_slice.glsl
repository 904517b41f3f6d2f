#include "lib/geometry.glsl"

// 1 where `inside` is at least 0, and a ramp down to 0 at -softness.
float depth_slice_ramp(float inside, float softness) {
    return inside >= 0.0 ? 1.0 : clamp(1.0 + inside / max(softness, 1e-9), 0.0, 1.0);
}

float depth_slice(
    float depth, float near, float far, float near_softness, float far_softness, bool invert
) {
    float away = is_surface(depth) ? depth : GEOMETRY_NOTHING;
    float mask = depth_slice_ramp(away - finite(near), finite(near_softness))
               * depth_slice_ramp(finite(far) - away, finite(far_softness));
    return invert ? 1.0 - mask : mask;
}
