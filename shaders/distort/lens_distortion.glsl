#include "lib/finite.glsl"
#include "lib/footprint.glsl"
#include "lib/sampling.glsl"

const float lens_distortion_nowhere = 1e6;  // in focal lengths: a place outside of every picture

// Where the lens shows a point (Brown 1966, Conrady 1919). Both are distances from the axis in focal lengths.
vec2 lens_distortion_bend(vec2 p, vec3 radial, vec2 tangential) {
    float r2 = dot(p, p);
    return p * (1.0 + r2 * (radial.x + r2 * (radial.y + r2 * radial.z)))
         + 2.0 * p.x * p.y * tangential + (r2 + 2.0 * p * p) * tangential.yx;
}

// The derivative of lens_distortion_bend(), by columns.
mat2 lens_distortion_slope(vec2 p, vec3 radial, vec2 tangential) {
    float r2 = dot(p, p), scale = 1.0 + r2 * (radial.x + r2 * (radial.y + r2 * radial.z));
    float rise = 2.0 * (radial.x + r2 * (2.0 * radial.y + r2 * 3.0 * radial.z));
    float mixed = rise * p.x * p.y + 2.0 * dot(p, tangential);
    return mat2(
        scale + rise * p.x * p.x + 2.0 * p.y * tangential.x + 6.0 * p.x * tangential.y, mixed,
        mixed, scale + rise * p.y * p.y + 2.0 * p.x * tangential.y + 6.0 * p.y * tangential.x
    );
}

// The inverse of lens_distortion_bend(), by Newton's method. The target moves from the center to `seen` in four steps,
// so that the solution stays on the inner branch. `far` is the radius at which the curve of the distortion turns back:
// nothing is visible beyond it.
vec2 lens_distortion_straighten(vec2 seen, vec3 radial, vec2 tangential, float far) {
    const int steps = 4, refinements = 4;
    vec2 p = vec2(0.0);
    for (int i = 0; i < steps + refinements; ++i) {
        vec2 target = seen * min(float(i + 1) / float(steps), 1.0);
        mat2 slope = lens_distortion_slope(p, radial, tangential);
        if (determinant(slope) < 1e-3) return vec2(lens_distortion_nowhere);
        p += inverse(slope) * (target - lens_distortion_bend(p, radial, tangential));
    }
    // Less slope is no inner branch; `missed` is in focal lengths: half a pixel for 500 pixels.
    float missed = distance(lens_distortion_bend(p, radial, tangential), seen);
    return missed < 1e-3 && length(p) < far && determinant(lens_distortion_slope(p, radial, tangential)) > 1e-3
         ? p : vec2(lens_distortion_nowhere);
}

vec2 lens_distortion_source(
    vec2 at, int direction, vec3 radial, vec2 tangential, float focal, float zoom, vec2 center, float far
) {
    vec2 p = (at - center) / (focal * zoom);
    p = direction == DIRECTION_DISTORT ? lens_distortion_straighten(p, radial, tangential, far)
                                       : lens_distortion_bend(p, radial, tangential);
    return center + p * focal;
}

vec4 lens_distortion(
    int direction, vec3 radial, vec2 tangential, float focal, float zoom, vec2 center, float far, int kernel
) {
    vec2 at = vec2(pixel) + 0.5;
    vec2 here = lens_distortion_source(at, direction, radial, tangential, focal, zoom, center, far);
    // The derivative gives the footprint of the pixel. Differences would need the costly inverse at more places.
    vec2 p = direction == DIRECTION_DISTORT ? (here - center) / focal : (at - center) / (focal * zoom);
    mat2 slope = lens_distortion_slope(p, radial, tangential);
    if (direction == DIRECTION_DISTORT) slope = inverse(slope);
    int n = footprint_samples(slope[0] / zoom, slope[1] / zoom);
    if (n == 1) return finite(image_filtered(here, kernel));
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i) {
        vec2 from = at + footprint_at(i, n);
        vec2 source = lens_distortion_source(from, direction, radial, tangential, focal, zoom, center, far);
        sum += image_filtered(source, kernel);
    }
    return finite(sum / float(n * n));
}
