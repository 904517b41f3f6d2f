// Pixels that two surfaces share, in passes that read `normal` and `near` (nearness: 1 / depth, 0 on the background).
//
// A renderer filters normals and colors over a pixel, but not depth. So at a silhouette or a crease a normal is the mean
// of two surfaces: N = c F + (1 - c) B, with the coverage c of the front surface F. It belongs to neither, and light
// computed from it is wrong. B is that of a pixel nearby which lies wholly in the back surface, and F has length 1; both
// together give c and F. Each surface is then shaded alone, and their lights are added by coverage. Pixels with normals
// of length 1 are left as they are, so renders without antialiasing stay exact.
#include "lib/camera.glsl"
#include "lib/geometry.glsl"

const int COVERAGE_REACH = 2;           // pixels: how far away a surface is looked for
const int COVERAGE_CELLS = 25;          // pixels within that reach
const int COVERAGE_SELF = 12;           // the number of the pixel itself among them
const float COVERAGE_WHOLE = 0.998;     // shorter normals may be means; curved surfaces shorten normals a little too
const float COVERAGE_NOTHING = 0.004;   // a normal of one sample among 256
const float COVERAGE_IMPURE = 100.0;    // weight of a lack in length against squared pixels: 0.98 is 1.4 pixels away
const float COVERAGE_STEEP = 8.0;       // depth that differs by 1 / 8 counts as a different surface
const float COVERAGE_CONTRAST = 10.0;   // squared pixels: so much farther may a surface lie that differs by 1
const float COVERAGE_DIFFERENT = 0.02;  // least square of the difference between two surfaces: 8 degrees

// The surfaces of a pixel: how much the front one covers, and a pixel near by that lies wholly in each. `front` and
// `back` are the pixel itself, with coverage 1, where there is only one.
struct Coverage { float front_share; ivec2 front, back; };

ivec2 coverage_cell(int i) { return pixel + ivec2(i % 5, i / 5) - COVERAGE_REACH; }

// The unit normal of a pixel, 0 on the background.
vec3 coverage_normal(ivec2 at) { return near_at(at) > 0.0 ? unit_normal(normal_at(at)) : vec3(0.0); }

// How unsuitable a pixel is to stand for a surface: its squared distance, and how far its normal is from that of one
// surface.
float coverage_cost(int i) {
    ivec2 at = coverage_cell(i), away = at - pixel;
    float size = length(finite(normal_at(at))), lack = near_at(at) > 0.0 ? abs(1.0 - size) : size;
    bool outside = any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, extent));
    return outside || i == COVERAGE_SELF ? 1e9 : float(away.x * away.x + away.y * away.y) + COVERAGE_IMPURE * lack;
}

// The square of the difference between two surfaces, by direction and depth.
float coverage_apart(vec3 normal, float near, ivec2 at) {
    vec3 turned = normal - coverage_normal(at);
    float other = near_at(at), deep = COVERAGE_STEEP * abs(near - other) / max(max(near, other), 1e-30);
    return dot(turned, turned) + min(deep * deep, 1.0);
}

// How much the front surface covers, from the mean normal of a pixel and the normal of the back surface.
float coverage_share(vec3 mean, vec3 back) {
    vec3 apart = mean - back;
    float toward = back == vec3(0.0) ? 0.0 : -2.0 * dot(apart, back);
    float share = back == vec3(0.0) ? length(mean) : dot(apart, apart) / max(toward, 1e-6);
    return clamp(share, 0.0, 1.0);
}

// The surfaces of this pixel, as one color to be stored: see coverage_of().
vec3 coverage_found() {
    vec3 mean = finite(normal_at(pixel));
    float size = length(mean);
    bool mixed = size > COVERAGE_NOTHING && (near_at(pixel) <= 0.0 || size < COVERAGE_WHOLE);
    int count = mixed ? COVERAGE_CELLS : 0, one = COVERAGE_SELF, other = COVERAGE_SELF;
    float least = 1e8;
    for (int i = 0; i < count; ++i) {
        float cost = coverage_cost(i);
        if (cost < least) least = cost, one = i;
    }
    ivec2 first = coverage_cell(one);
    vec3 normal = coverage_normal(first);
    float near = near_at(first);
    least = 1e8;
    for (int i = 0; i < count; ++i) {
        float apart = coverage_apart(normal, near, coverage_cell(i));
        float cost = coverage_cost(i) - COVERAGE_CONTRAST * min(apart, 1.0);
        if (apart > COVERAGE_DIFFERENT && cost < least) least = cost, other = i;
    }
    if (one == COVERAGE_SELF || other == COVERAGE_SELF) return vec3(1.0, COVERAGE_SELF, COVERAGE_SELF);
    bool swapped = near_at(coverage_cell(other)) > near;
    ivec2 sides = swapped ? ivec2(other, one) : ivec2(one, other);
    return vec3(coverage_share(mean, coverage_normal(coverage_cell(sides.y))), vec2(sides));
}

// The surfaces of this pixel, from what coverage_found() returned.
Coverage coverage_of(vec3 stored) { return Coverage(stored.x, coverage_cell(int(stored.y)), coverage_cell(int(stored.z))); }

bool coverage_is_mixed(Coverage shares) { return shares.front != shares.back; }

// The normal of the front surface alone. Where it covers little, its own normal helps against noise.
vec3 coverage_front(Coverage shares) {
    vec3 mean = finite(normal_at(pixel)), back = coverage_normal(shares.back), front = coverage_normal(shares.front);
    vec3 alone = mean - (1.0 - shares.front_share) * back + 0.02 * front;
    return dot(alone, alone) > 0.0 ? normalize(alone) : front;
}

// The part of the color of this pixel that is that of the front surface.
vec4 coverage_part(vec4 color, vec4 back, float front_share) { return max(color - (1.0 - front_share) * back, 0.0); }

// The place of a surface on the ray of this pixel, if it goes on from a place near by as a plane.
vec3 coverage_place(const vec4 rays[3], vec3 place, vec3 normal) {
    const float nearest = 0.9, farthest = 1.1;
    vec3 eye = camera_eye(rays), ray = camera_ray(rays, camera_uv(pixel, extent)), away = place - eye;
    float ahead = dot(ray, away) / dot(ray, ray), plane = dot(normal, away) / dot(normal, ray);
    return plane > nearest * ahead && plane < farthest * ahead ? eye + plane * ray : place;
}
