// What surfaces see of the half space before them. Places are relative to the eye, so that far scenes keep digits.
#include "lib/blue_noise.glsl"
#include "lib/camera.glsl"
#include "lib/geometry.glsl"

const float OCCLUSION_PI = 3.14159265;
const float OCCLUSION_GOLDEN = 0.61803399;
const float OCCLUSION_NEXT = 1.3;  // pixels: what lies nearer is the pixel itself (XeGTAO)

// A point of a surface, and the unit vector from it to the eye.
struct Seen { vec3 place, normal, view; vec2 uv; };

// The half plane that contains the view vector and `along`, a unit vector across it, together with its opposite half.
struct Slice {
    vec3 along;
    vec2 pace;    // pixels to a world unit along it
    float tilt;   // the angle from the view to the normal within the slice
    float share;  // the length of the normal within the slice
};

// A normal that faces the eye: shading normals may turn away at rims, and where there is none, the view stands in.
Seen seen_at(const vec4 rays[3], vec2 uv, float depth, vec3 normal) {
    vec3 ray = camera_ray(rays, uv), view = -normalize(ray);
    normal = unit_normal(normal);
    normal -= min(dot(normal, view), 0.0) * view;
    float size = length(normal);
    return Seen(depth * ray, size > 1e-3 ? normal / size : view, view, uv);
}

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

// The distance of neighboring pixels on a surface that faces the eye.
float pixel_pitch(const vec4 rays[3], float depth, vec2 size) {
    return depth * length(vec3(rays[0].x, rays[1].x, rays[2].x)) / size.x;
}

// The place at a position within a pixel whose depth is known in its middle. If that lies on the tangent plane at
// `here`, so does all of the pixel: without this, flat surfaces would hide themselves by the rounding of positions.
vec3 place_beside(const vec4 rays[3], Seen here, ivec2 other, vec2 at, vec2 size, float depth) {
    vec3 middle = camera_ray(rays, (vec2(other) + 0.5) / size), ray = camera_ray(rays, at / size);
    float off = abs(dot(here.normal, depth * middle - here.place)) / pixel_pitch(rays, depth, size);
    vec3 along = clamp(dot(here.normal, middle) / dot(here.normal, ray), 0.5, 2.0) * ray;
    return depth * mix(middle, along, clamp(2.0 - off, 0.0, 1.0));
}

// How much light an even sky sends through a slice between the view and an angle `to`, by the cosine to the normal
// (Jimenez et al. 2016): the integral of cos(t - tilt) |sin t|.
float slice_light(float tilt, float to) { return 0.25 * (cos(tilt) + 2.0 * to * sin(tilt) - cos(2.0 * to - tilt)); }

// All that an open half space sends through it.
float slice_whole(float tilt) { return cos(tilt) + tilt * sin(tilt); }

// The angle up to which `part` of the light between the view and `to` passes: as if it went by sin^2, and one step of
// Newton's, which leaves 0.002 of it on average.
float slice_reach(float tilt, float to, float part) {
    float end = abs(to), lean = to < 0.0 ? -tilt : tilt, stretch = 1.0 + lean / (0.5 * OCCLUSION_PI);
    if (end < 1e-4) return 0.0;
    float angle = asin(clamp(sqrt(part) * sin(end / stretch), 0.0, 1.0)) * stretch;
    float lacking = part * slice_light(lean, end) - slice_light(lean, angle);
    angle = clamp(angle + lacking / max(cos(angle - lean) * sin(angle), 1e-3), 0.0, end);
    return to < 0.0 ? -angle : angle;
}

// The sum of the directions, along the slice and along the view, of that light between the view and an angle: the
// integral of (sin t, cos t) cos(t - tilt) |sin t|.
vec2 slice_direction(float tilt, float to) {
    return vec2(
        6.0 * sin(to - tilt) - sin(3.0 * to - tilt) - 3.0 * sin(to + tilt) + 8.0 * sin(tilt),
        -cos(3.0 * to - tilt) - 3.0 * cos(to + tilt) + 4.0 * cos(tilt)
    ) / 12.0;
}

// Two numbers in 0..1 for the turn and the start of the steps of a pixel. `matched`: of every 4 x 4 pixels, each has
// another point of a lattice (Korobov 1959), and those of a row lie evenly, for an average over just as many.
vec2 occlusion_noise(ivec2 at, bool matched) {
    vec2 random = vec2(blue_noise(at), blue_noise(at + ivec2(48, 36)));
    if (!matched) return random;
    int index = 4 * ((at.x + at.y) & 3) + 2 * (at.y & 1) + ((at.y >> 1) & 1);
    return (vec2(index, (7 * index) & 15) + random) / 16.0;
}

// How surely two pixels show the same surface: alike in turn, and on each other's tangent planes, in units of `apart`.
float same_surface(vec3 normal, vec3 other, vec3 way, float apart) {
    float off = max(abs(dot(way, normal)), abs(dot(way, other))) / apart;
    return clamp(2.0 - off, 0.0, 1.0) * clamp(3.0 * dot(normal, other) - 1.5, 0.0, 1.0);
}
