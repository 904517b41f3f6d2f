#include "lib/camera.glsl"
#include "lib/geometry.glsl"

// (1 - exp(-x)) / x for x >= 0. Small x use the series, since the difference would lose digits.
float fog_mean(float x) { return x < 0.05 ? 1.0 - x * (0.5 - x * (1.0 / 6.0 - x / 24.0)) : (1.0 - exp(-x)) / x; }

// Optical depth of an exponential layer of fog between two heights, in units of its thickness. It is computed from the
// lower height, for both directions of view, so that no exponential overflows: exp(88) is the
// largest that a float holds.
float fog_layer(float density, float way, float from, float to) {
    return density * way * exp(clamp(-min(from, to), -80.0, 80.0)) * fog_mean(min(abs(to - from), 80.0));
}

// The same from a height to infinity. `rise` is the gain of height per unit of distance.
float fog_layer_above(float density, float from, float rise) {
    return rise > 0.0 ? density * exp(clamp(-from, -80.0, 80.0)) / rise : GEOMETRY_NOTHING;
}

float fog_amount(
    float depth, vec3 position, vec4 rays[3], bool seen, bool placed, int mode, float density, float start, float end,
    float base, float thickness, int up, float eye, float sky, float most
) {
    bool there = is_surface(depth);
    vec3 ray = camera_ray(rays, camera_uv(pixel, extent));
    float far = !there ? GEOMETRY_NOTHING : seen ? depth * length(ray) : depth, way = max(far - start, 0.0);
    float thick = density * way;
    if (mode == MODE_LINEAR) return most * (there ? clamp(way / max(end - start, 1e-6), 0.0, 1.0) : sky);
    if (mode == MODE_EXPONENTIAL_SQUARED) thick *= thick;
    if (mode == MODE_HEIGHT && seen) {
        int axis = up == UP_Z ? 2 : 1;
        float rise = normalize(ray)[axis] / thickness, from = (camera_eye(rays)[axis] - base) / thickness + start * rise;
        thick = there ? fog_layer(density, way, from, from + way * rise) : fog_layer_above(density, from, rise);
    } else if (mode == MODE_HEIGHT && placed && there) {
        vec2 ends = (vec2(eye, finite(position[up == UP_Z ? 2 : 1])) - base) / thickness;
        thick = fog_layer(density, way, mix(ends.x, ends.y, min(start / far, 1.0)), ends.y);
    }
    return most * (1.0 - exp(-min(thick, 80.0))) * (there ? 1.0 : sky);
}

vec4 fog(
    vec4 image, float amount, vec4 rays[3], vec3 color, int alpha, float sun, vec3 sun_color, vec3 sun_direction,
    float sun_focus
) {
    vec4 safe = finite(image);
    vec3 ray = camera_ray(rays, camera_uv(pixel, extent));
    float along = dot(ray, sun_direction) / max(length(ray), 1e-9);
    vec3 light = along > 0.0 ? mix(color, sun_color, sun * pow(along, sun_focus)) : color;
    float covered = alpha == ALPHA_KEEP ? clamp(safe.a, 0.0, 1.0) : 1.0;
    vec3 rgb = safe.rgb * (1.0 - amount) + light * (amount * covered);
    return finite(vec4(rgb, alpha == ALPHA_KEEP ? safe.a : safe.a * (1.0 - amount) + amount));
}
