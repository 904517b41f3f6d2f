// How deep the objects of a picture are: as deep as they are wide. Seen from any side, a slice through a ball is a
// circle, whose width the picture shows; at a place with `a` pixels to the left end of the circle and `b` to the right
// one it is 2 sqrt(a b) deep, if that is a length at its middle: its front is nearer and looks larger. Of the slices
// across and down the thinner one counts, so a rod is as deep as it is thick.
// Surfaces that reach the border of the picture count as endless on that side.
//
// `runs` holds how many pixels of the same surface follow to the left, to the right, above and below.
#include "lib/camera.glsl"

// Pixels of depth by which neighbors may leave each other's plane. A choice: with half or twice the number, under 1 %
// of the pixels of the preset late_sun change by more than 1 / 255.
const float SOLID_STEP = 2.0;
const float SOLID_ENDLESS = 1e4;  // pixels: more than a picture has

// The way to the next pixel on a side.
ivec2 solid_way(int side) { return ivec2[4](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1))[side]; }

// True if the pixel beside this one shows the same surface: one of both lies on the plane of the other.
bool solid_goes_on(const vec4 rays[3], vec4 here, ivec2 away) {
    vec4 other = planes_at(pixel + away);
    if (other.x <= 0.0) return false;
    float apart = other.x - here.x, pitch = length(vec3(rays[0].x, rays[1].x, rays[2].x)) / float(extent.x);
    vec2 off = abs(apart - vec2(dot(here.yz, vec2(away)), dot(other.yz, vec2(away))));
    return min(off.x, off.y) < SOLID_STEP * pitch * max(here.x, other.x);
}

// The first draw, which reads `planes`: 1 where the next pixel belongs to the same surface.
vec4 solid_neighbors(const vec4 rays[3]) {
    vec4 here = planes_at(pixel), runs = vec4(0.0);
    if (here.x <= 0.0) return runs;
    for (int side = 0; side < 4; ++side) {
        ivec2 at = pixel + solid_way(side);
        bool outside = any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, extent));
        runs[side] = outside ? SOLID_ENDLESS : solid_goes_on(rays, here, solid_way(side)) ? 1.0 : 0.0;
    }
    return runs;
}

// A later draw, which reads `runs` of up to `reach` pixels and makes those of up to twice as many.
vec4 solid_runs(int reach) {
    vec4 runs = runs_at(pixel);
    for (int side = 0; side < 4; ++side)
        if (runs[side] == float(reach)) runs[side] += runs_at(pixel + reach * solid_way(side))[side];
    return runs;
}

// The last draw: the plane of every pixel, and the depth of its object in world units.
vec4 solid_planes(const vec4 rays[3]) {
    vec4 plane = planes_at(pixel), runs = runs_at(pixel) + 0.5;
    if (plane.x <= 0.0) return plane;
    vec2 halves = sqrt(runs.xz * runs.yw);
    // A circle that ends at an angle of tangent `wide` has a radius of q = wide / sqrt(1 + wide^2) of the distance to its
    // middle, which is 1 / (1 - q) times as far away as its front.
    float wide = min(halves.x, halves.y) * length(vec3(rays[0].x, rays[1].x, rays[2].x)) / float(extent.x);
    return vec4(plane.xyz, 2.0 * wide * (wide + sqrt(1.0 + wide * wide)) / plane.x);
}
