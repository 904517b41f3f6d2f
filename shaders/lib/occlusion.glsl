// How much of the hemisphere above a surface is open. Positions are relative to the camera, so that distant scenes keep
// precision.
#include "lib/blue_noise.glsl"
#include "lib/camera.glsl"
#include "lib/geometry.glsl"
#include "lib/pi.glsl"

const float OCCLUSION_GOLDEN = 0.61803399;
const float OCCLUSION_NEXT = 1.3;  // pixels: nearer samples would be the pixel itself (XeGTAO)

// A point on a surface, and the unit vector from it to the camera.
struct Seen { vec3 place, normal, view; vec2 uv; };

// The plane that contains the view vector and `along`, a unit vector perpendicular to it.
struct Slice {
    vec3 along;
    vec2 pace;    // pixels per world unit along it
    float tilt;   // angle from the view to the normal within the slice
    float share;  // length of the normal within the slice
};

// A surface point with a normal that faces the camera: interpolated normals may face away at rims. Without a normal,
// the view vector is used.
Seen seen_at(const vec4 rays[3], vec2 uv, float depth, vec3 normal) {
    vec3 ray = camera_ray(rays, uv), view = -normalize(ray);
    normal = unit_normal(normal);
    normal -= min(dot(normal, view), 0.0) * view;
    float size = length(normal);
    return Seen(depth * ray, size > 1e-3 ? normal / size : view, view, uv);
}

// The slice through a surface point at an angle around the view vector.
Slice slice_at(const vec4 rows[3], const vec4 rays[3], Seen seen, vec2 size, float angle) {
    vec3 right = vec3(rays[0].x, rays[1].x, rays[2].x);
    right = normalize(right - dot(right, seen.view) * seen.view);
    vec3 along = cos(angle) * right + sin(angle) * cross(seen.view, right);
    vec3 moved = vec3(dot(rows[0].xyz, along), dot(rows[1].xyz, along), dot(rows[2].xyz, along));
    vec2 pace = (moved.xy - seen.uv * moved.z) * size / dot(rows[2].xyz, seen.place);
    vec3 axis = cross(along, seen.view), within = seen.normal - dot(seen.normal, axis) * axis;
    float share = length(within), lift = clamp(dot(within, seen.view) / max(share, 1e-6), -1.0, 1.0);
    return Slice(along, pace, dot(within, along) < 0.0 ? -acos(lift) : acos(lift), share);
}

// The distance between neighboring pixels on a surface that faces the camera.
float pixel_pitch(const vec4 rays[3], float depth, vec2 size) {
    return depth * length(vec3(rays[0].x, rays[1].x, rays[2].x)) / size.x;
}

// The position of a point within a pixel whose depth is known at its center. If the center lies on the tangent plane at
// `here`, the whole pixel does: otherwise flat surfaces would occlude themselves by rounding of positions.
vec3 place_beside(const vec4 rays[3], Seen here, ivec2 other, vec2 at, vec2 size, float depth) {
    vec3 middle = camera_ray(rays, (vec2(other) + 0.5) / size), ray = camera_ray(rays, at / size);
    float off = abs(dot(here.normal, depth * middle - here.place)) / pixel_pitch(rays, depth, size);
    vec3 along = clamp(dot(here.normal, middle) / dot(here.normal, ray), 0.5, 2.0) * ray;
    return depth * mix(middle, along, clamp(2.0 - off, 0.0, 1.0));
}

// The light from a uniform sky through a slice between the view and the angle `to`, weighted by the cosine to the
// normal (Jimenez et al. 2016): the integral of cos(t - tilt) |sin t|.
float slice_light(float tilt, float to) { return 0.25 * (cos(tilt) + 2.0 * to * sin(tilt) - cos(2.0 * to - tilt)); }

// The light of a whole open hemisphere through a slice.
float slice_whole(float tilt) { return cos(tilt) + tilt * sin(tilt); }

// The angle up to which `part` of the light between the view and `to` passes: an approximation by sin^2, then one step
// of Newton's method. The mean error is 0.002 of the light.
float slice_reach(float tilt, float to, float part) {
    float end = abs(to), lean = to < 0.0 ? -tilt : tilt, stretch = 1.0 + lean / (0.5 * PI);
    if (end < 1e-4) return 0.0;
    float angle = asin(clamp(sqrt(part) * sin(end / stretch), 0.0, 1.0)) * stretch;
    float lacking = part * slice_light(lean, end) - slice_light(lean, angle);
    angle = clamp(angle + lacking / max(cos(angle - lean) * sin(angle), 1e-3), 0.0, end);
    return to < 0.0 ? -angle : angle;
}

// The sum of the directions of that light, along the slice and along the view: the integral of (sin t, cos t) cos(t -
// tilt) |sin t|.
vec2 slice_direction(float tilt, float to) {
    return vec2(
        6.0 * sin(to - tilt) - sin(3.0 * to - tilt) - 3.0 * sin(to + tilt) + 8.0 * sin(tilt),
        -cos(3.0 * to - tilt) - 3.0 * cos(to + tilt) + 4.0 * cos(tilt)
    ) / 12.0;
}

// Two random numbers in 0..1 for the rotation and the start of the steps at a pixel. With `matched`, the 16 pixels of
// every 4 x 4 have the points of a lattice (Korobov 1959), with rows evenly distributed, for an average over 4 x 4
// pixels.
vec2 occlusion_noise(ivec2 at, bool matched) {
    vec2 random = vec2(blue_noise(at), blue_noise(at + ivec2(48, 36)));
    if (!matched) return random;
    int index = 4 * ((at.x + at.y) & 3) + 2 * (at.y & 1) + ((at.y >> 1) & 1);
    return (vec2(index, (7 * index) & 15) + random) / 16.0;
}

// The weight by which two pixels show the same surface: similar normals, and each on the other's tangent plane within
// `apart`.
float same_surface(vec3 normal, vec3 other, vec3 way, float apart) {
    float off = max(abs(dot(way, normal)), abs(dot(way, other))) / apart;
    return clamp(2.0 - off, 0.0, 1.0) * clamp(3.0 * dot(normal, other) - 1.5, 0.0, 1.0);
}
