// Shadows along rays through the picture, in passes that read `surfaces` (see lib/march.glsl) and `normal`.
#include "lib/march.glsl"
#include "lib/occlusion.glsl"

// The normal of a pixel; that of the depth where it is missing, or a mean of two surfaces.
vec3 shadow_normal(const vec4 rows[3], ivec2 at) {
    vec3 normal = normal_at(at);
    return is_finite(normal) && !is_mixed(normal) ? unit_normal(normal) : march_normal(rows, at, extent);
}

// How open a way from a surface is: 1 if nothing is met. Hits near the far end fade out, so that no shadow ends
// abruptly.
float shadow_open(
    const vec4 rows[3], vec2 uv, float depth, vec3 way, vec3 plane, float reach, float thickness, vec2 size
) {
    March ray = march_start(rows, uv, depth, march_out(way, plane), reach, false, size);
    bool met = march(ray, ivec2(size), thickness, march_longest(ivec2(size)));
    return met ? 1.0 - ray.sure * clamp(3.0 - 3.0 * march_distance(ray) / reach, 0.0, 1.0) : 1.0;
}

// The weight of a pixel near by in the mean over 4 x 4 pixels of the same surface, which is one period of the noise.
// `here` is the position of this pixel from the camera; 0 outside of the picture and on the background.
float shadow_weight(const vec4 rows[3], const vec4 rays[3], ivec2 off, vec3 normal, vec3 here, float apart) {
    ivec2 at = pixel + off;
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, extent)) || surfaces_at(at).x <= 0.0) return 0.0;
    vec3 away = camera_ray(rays, camera_uv(at, extent)) / surfaces_at(at).x - here;
    float weight = (abs(off.x) == 2 ? 0.5 : 1.0) * (abs(off.y) == 2 ? 0.5 : 1.0);
    return weight * (at == pixel ? 1.0 : same_surface(normal, shadow_normal(rows, at), away, apart));
}
