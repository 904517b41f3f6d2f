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
const ivec2 COVERAGE_SELF = ivec2(0);   // the offset of the pixel itself
// Half and twice each of the numbers that have no other reason changes less than 1 % of the pixels that the node
// screen_reflections makes of the sample frame by more than 1 / 255: they are choices.
const float COVERAGE_WHOLE = 0.998;     // shorter normals may be means: this one of two that are 7 degrees apart
const float COVERAGE_NOTHING = 0.004;   // a normal of one sample among 256
const float COVERAGE_LACK = 0.03;       // a pixel of which another surface covers so much counts as wholly in one
const float COVERAGE_IMPURE = 100.0;    // weight of a lack in length against squared pixels: 0.98 is 1.4 pixels away
const float COVERAGE_STEEP = 8.0;       // depth that differs by 1 / 8 counts as a different surface
const float COVERAGE_CONTRAST = 10.0;   // squared pixels: so much farther may a surface lie that differs by 1
const float COVERAGE_NEVER = 1e9;       // the cost of what lies outside of the picture
const float COVERAGE_LIMIT = 1e8;       // costs from here on are that
// How much of its own normal a front surface gets, against noise where it covers little. A choice: with half or twice the
// number 1 % of the pixels of the preset night_relight change by more than 1 / 255.
const float COVERAGE_OWN = 0.02;
// How far along the ray a plane may go on, as a part of the distance: farther it is seen edge-on. A choice: with 0.95 and
// 1.05, or 0.8 and 1.2, no pixel of night_relight changes by more than 1 / 255.
const float COVERAGE_NEAREST = 0.9, COVERAGE_FARTHEST = 1.1;
const float COVERAGE_DIFFERENT = 0.02;  // least square of the difference between two surfaces: 8 degrees

// Choices: with half or twice each of these two numbers less than 1 % of the pixels of night_relight change by more than
// 1 / 255.
const float COVERAGE_ALIKE = 0.005;     // colors with less contrast, a tenth of both, say nothing
const float COVERAGE_DOUBT = 0.05;      // a color that is farther from the mixes of two than by this part of their distance
                                        // is another texture, or that of a third surface

// The surfaces of a pixel: how much the front one covers, and a pixel near by that lies wholly in each. `front` and
// `back` are the pixel itself, with coverage 1, where there is only one.
struct Coverage { float front_share; ivec2 front, back; };

// The unit normal of a pixel, 0 on the background.
vec3 coverage_normal(ivec2 at) { return near_at(at) > 0.0 ? unit_normal(normal_at(at)) : vec3(0.0); }

// How unsuitable a pixel is to stand for a surface: its squared distance, and how far its normal is from that of one
// surface.
float coverage_cost(ivec2 away) {
    ivec2 at = pixel + away;
    float size = length(finite(normal_at(at))), lack = near_at(at) > 0.0 ? abs(1.0 - size) : size;
    bool outside = any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, extent));
    return outside || away == COVERAGE_SELF ? COVERAGE_NEVER : float(away.x * away.x + away.y * away.y) + COVERAGE_IMPURE * lack;
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

// How much the front surface covers, where the color of the pixel is a mix of those of both surfaces: then color knows it
// better than a normal, which also turns within a pixel. `share` is what the normal says. All are premultiplied.
float coverage_color_share(float share, vec4 color, vec4 front, vec4 back) {
    vec4 apart = front - back;
    float span = dot(apart, apart), contrast = span / max(dot(front, front) + dot(back, back), 1e-12);
    float mixed = clamp(dot(color - back, apart) / max(span, 1e-12), 0.0, 1.0);
    vec4 off = color - back - mixed * apart;
    float doubt = sqrt(dot(off, off) / max(span, 1e-12));
    float trust = clamp(contrast / COVERAGE_ALIKE - 1.0, 0.0, 1.0) * clamp(2.0 - doubt / COVERAGE_DOUBT, 0.0, 1.0);
    return mix(share, mixed, trust);
}

// The ways to the pixels that stand for the front surface (xy) and the one behind (zw); 0 if there is only one.
ivec4 coverage_sides() {
    const int reach = COVERAGE_REACH;
    ivec2 first_way = COVERAGE_SELF, second_way = COVERAGE_SELF;
    float least = COVERAGE_LIMIT;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            float cost = coverage_cost(ivec2(x, y));
            if (cost < least) least = cost, first_way = ivec2(x, y);
        }
    vec3 normal = coverage_normal(pixel + first_way);
    float near = near_at(pixel + first_way);
    least = COVERAGE_LIMIT;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            float apart = coverage_apart(normal, near, pixel + ivec2(x, y));
            float cost = coverage_cost(ivec2(x, y)) - COVERAGE_CONTRAST * min(apart, 1.0);
            if (apart > COVERAGE_DIFFERENT && cost < least) least = cost, second_way = ivec2(x, y);
        }
    if (first_way == COVERAGE_SELF || second_way == COVERAGE_SELF) return ivec4(0);
    return near_at(pixel + second_way) > near ? ivec4(second_way, first_way) : ivec4(first_way, second_way);
}

// The surfaces of this pixel as numbers to be stored: see coverage_of(). The search is a loop of one round or none: a
// software rasterizer runs both sides of a branch, but leaves a loop once no pixel needs it.
vec3 coverage_found() {
    vec3 mean = finite(normal_at(pixel));
    float size = length(mean), share = 1.0;
    ivec4 sides = ivec4(0);
    bool mixed = size > COVERAGE_NOTHING && (near_at(pixel) <= 0.0 || size < COVERAGE_WHOLE);
    for (int rounds = mixed ? 1 : 0; rounds > 0; --rounds) {
        sides = coverage_sides();
        if (sides.xy != sides.zw) share = coverage_share(mean, coverage_normal(pixel + sides.zw));
    }
    return vec3(share, (sides.xy << 3) + sides.zw);
}

// The surfaces of this pixel, from what coverage_found() returned.
Coverage coverage_of(vec3 stored) {
    ivec2 sides = ivec2(stored.yz), front = (sides + COVERAGE_REACH) >> 3;
    return Coverage(stored.x, pixel + front, pixel + sides - (front << 3));
}

// True for a pixel that two surfaces share.
bool coverage_is_mixed(Coverage shares) { return shares.front != shares.back; }

// What coverage_found() returns, with the share by color as well, in passes that also read `albedo`.
vec3 coverage_found_by_color() {
    vec3 stored = coverage_found();
    Coverage shares = coverage_of(stored);
    for (int rounds = coverage_is_mixed(shares) ? 1 : 0; rounds > 0; --rounds)
        stored.x = coverage_color_share(
            stored.x, finite(albedo_at(pixel)), finite(albedo_at(shares.front)), finite(albedo_at(shares.back))
        );
    return stored;
}

// True for a pixel that two surfaces share, where its depth is that of one of them, and each of them covers a pixel
// beside it wholly. Things thinner than two pixels cover none.
bool coverage_is_sure(Coverage shares) {
    if (!coverage_is_mixed(shares)) return false;
    float front = length(finite(normal_at(shares.front))), back = length(finite(normal_at(shares.back)));
    float lack = near_at(shares.back) > 0.0 ? 1.0 - back : back;
    vec2 apart = abs(near_at(pixel) - vec2(near_at(shares.front), near_at(shares.back)));
    bool fits = COVERAGE_STEEP * min(apart.x, apart.y) <= near_at(pixel);
    return fits && max(abs(1.0 - front), abs(lack)) < COVERAGE_LACK;
}

// The same surfaces, where the pixel itself stands for the one that its depth shows: light that was measured at every
// pixel changes fast toward a rim. Only one surface where that is not sure.
Coverage coverage_seen(Coverage shares) {
    if (!coverage_is_sure(shares)) return Coverage(1.0, pixel, pixel);
    bool front = abs(near_at(pixel) - near_at(shares.front)) < abs(near_at(pixel) - near_at(shares.back));
    return Coverage(shares.front_share, front ? pixel : shares.front, front ? shares.back : pixel);
}

// The part of the mean normal of this pixel that is that of the front surface.
vec3 coverage_alone(Coverage shares) {
    return finite(normal_at(pixel)) - (1.0 - shares.front_share) * coverage_normal(shares.back);
}

// The normal of the front surface alone. Where it covers little, its own normal helps against noise.
vec3 coverage_front(Coverage shares) {
    vec3 front = coverage_normal(shares.front), alone = coverage_alone(shares) + COVERAGE_OWN * front;
    return dot(alone, alone) > 0.0 ? normalize(alone) : front;
}

// How much shorter the normal of the front surface is than those that it is the mean of: 1 where there is one. Light on
// matte surfaces grows with the cosine, so its mean over several normals is that of their mean, as it is.
float coverage_turned(Coverage shares) {
    return clamp(length(coverage_alone(shares)) / max(shares.front_share, COVERAGE_OWN), 0.0, 1.0);
}

// The part of the color of this pixel that is that of the front surface, from the colors of both beside it. What they
// lack in light or texture is divided in their proportion: to subtract one of them would leave black dots.
vec4 coverage_part(vec4 color, vec4 front, vec4 back, float front_share) {
    vec4 ours = max(front_share * front, 0.0), theirs = max((1.0 - front_share) * back, 0.0), both = ours + theirs;
    return color * mix(vec4(front_share), ours / max(both, 1e-20), greaterThan(both, vec4(1e-20)));
}

// The place of a surface on the ray of this pixel, if it goes on from a place near by as a plane.
vec3 coverage_place(const vec4 rays[3], vec3 place, vec3 normal) {
    vec3 eye = camera_eye(rays), ray = camera_ray(rays, camera_uv(pixel, extent)), away = place - eye;
    float ahead = dot(ray, away) / dot(ray, ray), plane = dot(normal, away) / dot(normal, ray);
    return plane > COVERAGE_NEAREST * ahead && plane < COVERAGE_FARTHEST * ahead ? eye + plane * ray : place;
}
