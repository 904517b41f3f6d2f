// Pixels that two surfaces share, in passes that read `normal` and `near` (nearness: 1 / depth, 0 on the background).
//
// A renderer filters normals and colors over a pixel, but not depth. So at a silhouette or a crease a normal is the mean
// of two surfaces: N = c F + (1 - c) B, with the coverage c of the front surface F. It belongs to neither, and light
// computed from it is wrong. F and B are known from pixels nearby, each as far as its surface turns up to here; both
// have length 1, and N says the rest. Each surface is then shaded alone, and their lights are added by coverage. One
// surface that turns within a pixel is no edge: there the normals beside it turn as well. Pixels with normals of length 1
// are left as they are, so renders without antialiasing stay exact.
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
const float COVERAGE_OWN = 0.02;        // the least coverage by which the length of a mean normal is divided
// How far along the ray a plane may go on, as a part of the distance: farther it is seen edge-on. A choice: with 0.95 and
// 1.05, or 0.8 and 1.2, no pixel of night_relight changes by more than 1 / 255.
const float COVERAGE_NEAREST = 0.9, COVERAGE_FARTHEST = 1.1;
const float COVERAGE_DIFFERENT = 0.02;  // least square of the difference between two surfaces: 8 degrees

// Choices: with half or twice each of these two numbers less than 1 % of the pixels of night_relight change by more than
// 1 / 255.
const float COVERAGE_ALIKE = 0.005;     // colors with less contrast, a tenth of both, say nothing
const float COVERAGE_DOUBT = 0.05;      // a color that is farther from the mixes of two than by this part of their distance
                                        // is another texture, or that of a third surface

// Choices: with half or twice each of these numbers errors at edges are up to 1.6 times as large in the scenes of
// tests/nodes/test_shared_metals.py and test_lights_of_cycles.py, and none is smaller by more than a tenth.
const float COVERAGE_MISFIT = 100.0;  // weight of the square of what two normals leave of the mean, against squared pixels
const float COVERAGE_NOISE = 1e-3;    // the variance of a mean normal: that of 48 samples, one of which sees another surface
const float COVERAGE_FLAT = 1e-4;     // the least variance of a normal from a pixel nearby: half a degree
const float COVERAGE_BENT = 5.0;      // one surface turns so much more than it shows: 1 on a ball, 4 where it only starts
const float COVERAGE_STEP = 0.5;      // squared: normals of neighbors that differ by more are of two surfaces
const float COVERAGE_LONG = 0.4;      // longer steps of a normal do not go on in the next pixel
const float COVERAGE_AGREE = 0.03;    // how far a share by color may be from those by normals
// A normal that turns evenly, all over a pixel, has the variance 1 - |N|^2 of a twelfth of the square of its step.
const float COVERAGE_TURNING = 12.0;

// The surfaces of a pixel: how much the front one covers, and a pixel near by that lies wholly in each. `front` and
// `back` are the pixel itself where there is only one, and the share is the length of its normal where it turns, else 1.
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

// The square of what two normals leave of the mean normal of a pixel, as the best mix of them.
float coverage_misfit(vec3 mean, vec3 first, vec3 second) {
    vec3 apart = second - first, off = mean - first;
    vec3 left = off - clamp(dot(off, apart) / max(dot(apart, apart), 1e-6), 0.0, 1.0) * apart;
    return dot(left, left);
}

// The square of the step of an evenly turning normal, from one pixel to the next.
float coverage_turning(ivec2 at) {
    vec3 there = finite(normal_at(at));
    return COVERAGE_TURNING * max(1.0 - dot(there, there), 0.0);
}

// What a pixel nearby says of the normal of its surface in this one: it goes on turning as there.
vec3 coverage_known(ivec2 at) {
    vec3 there = coverage_normal(at);
    ivec2 away = at - pixel, far = at + sign(away);
    vec3 turn = there - coverage_normal(far);
    float size = length(turn), most = min(sqrt(coverage_turning(at)) / max(size, 1e-9), 1.0);
    if (size >= COVERAGE_LONG) most = 0.0;
    bool inside = all(greaterThanEqual(far, ivec2(0))) && all(lessThan(far, extent));
    if (!inside || near_at(at) <= 0.0 || near_at(far) <= 0.0) return there;
    return unit_normal(there + float(max(abs(away.x), abs(away.y))) * most * turn);
}

// The variance of what it says, in squared radians.
float coverage_unsure(ivec2 at) {
    ivec2 away = at - pixel;
    return near_at(at) > 0.0 ? COVERAGE_FLAT + coverage_turning(at) * float(away.x * away.x + away.y * away.y) : 0.0;
}

// How much the front surface covers, from the mean normal of a pixel and the normal of the back surface.
float coverage_share(vec3 mean, vec3 back) {
    vec3 apart = mean - back;
    float toward = back == vec3(0.0) ? 0.0 : -2.0 * dot(apart, back);
    float share = back == vec3(0.0) ? length(mean) : dot(apart, apart) / max(toward, 1e-6);
    return clamp(share, 0.0, 1.0);
}

// How much the front surface covers, by the normal of the back surface (x) and by that of the front one (y).
vec2 coverage_by_normals(Coverage shares) {
    vec3 mean = finite(normal_at(pixel));
    float by_back = coverage_share(mean, coverage_known(shares.back));
    return vec2(by_back, 1.0 - coverage_share(mean, coverage_known(shares.front)));
}

// The mean of both, by how well each normal is known.
float coverage_balance(Coverage shares) {
    vec2 found = coverage_by_normals(shares);
    float ours = coverage_unsure(shares.front), theirs = coverage_unsure(shares.back);
    return ours + theirs > 0.0 ? (ours * found.x + theirs * found.y) / (ours + theirs) : found.x;
}

// How much the front surface covers, where the color of the pixel is a mix of those of both surfaces: then color knows it
// better than a normal, which also turns within a pixel. Normals say within which limits: mean normals are no longer than
// 1. A color beyond those is no mix, such as that of a metal, which shows what it mirrors. All are premultiplied.
float coverage_color_share(Coverage shares, vec4 color, vec4 front, vec4 back) {
    vec4 apart = front - back;
    float span = dot(apart, apart), contrast = span / max(dot(front, front) + dot(back, back), 1e-12);
    float mixed = clamp(dot(color - back, apart) / max(span, 1e-12), 0.0, 1.0);
    vec4 off = color - back - mixed * apart;
    float doubt = sqrt(dot(off, off) / max(span, 1e-12));
    float trust = clamp(contrast / COVERAGE_ALIKE - 1.0, 0.0, 1.0) * clamp(2.0 - doubt / COVERAGE_DOUBT, 0.0, 1.0);
    vec2 known = coverage_by_normals(shares);
    float beyond = mixed - clamp(mixed, min(known.x, known.y), max(known.x, known.y));
    trust *= clamp(2.0 - abs(beyond) / COVERAGE_AGREE, 0.0, 1.0);
    return mix(shares.front_share, mixed, trust);
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
    vec3 normal = coverage_normal(pixel + first_way), mean = finite(normal_at(pixel));
    float near = near_at(pixel + first_way);
    least = COVERAGE_LIMIT;
    for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x) {
            float apart = coverage_apart(normal, near, pixel + ivec2(x, y));
            float cost = coverage_cost(ivec2(x, y)) - COVERAGE_CONTRAST * min(apart, 1.0);
            cost += COVERAGE_MISFIT * coverage_misfit(mean, normal, coverage_normal(pixel + ivec2(x, y)));
            if (apart > COVERAGE_DIFFERENT && cost < least) least = cost, second_way = ivec2(x, y);
        }
    if (first_way == COVERAGE_SELF || second_way == COVERAGE_SELF) return ivec4(0);
    return near_at(pixel + second_way) > near ? ivec4(second_way, first_way) : ivec4(first_way, second_way);
}

// The square of what the normal grows by along an axis, on the side where it is less.
float coverage_step(vec3 normal, ivec2 way) {
    vec3 after = coverage_normal(pixel + way) - normal, before = normal - coverage_normal(pixel - way);
    float least = min(dot(after, after), dot(before, before));
    return least < COVERAGE_STEP ? least : 0.0;
}

// True where a normal is shorter because one surface turns within the pixel, as the normals beside it do.
bool coverage_is_bend(vec3 mean) {
    vec3 normal = unit_normal(mean);
    float steps = coverage_step(normal, ivec2(1, 0)) + coverage_step(normal, ivec2(0, 1));
    return near_at(pixel) > 0.0 && 1.0 - dot(mean, mean) < COVERAGE_BENT / COVERAGE_TURNING * steps;
}

// The surfaces of this pixel as numbers to be stored: see coverage_of(). The search is a loop of one round or none: a
// software rasterizer runs both sides of a branch, but leaves a loop once no pixel needs it.
vec3 coverage_found() {
    vec3 mean = finite(normal_at(pixel));
    float size = length(mean), share = 1.0;
    ivec4 sides = ivec4(0);
    bool mixed = size > COVERAGE_NOTHING && (near_at(pixel) <= 0.0 || size < COVERAGE_WHOLE);
    for (int rounds = mixed ? 1 : 0; rounds > 0; --rounds) {
        if (coverage_is_bend(mean)) { share = size; break; }
        sides = coverage_sides();
        if (sides.xy != sides.zw) share = coverage_balance(Coverage(share, pixel + sides.xy, pixel + sides.zw));
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
            shares, finite(albedo_at(pixel)), finite(albedo_at(shares.front)), finite(albedo_at(shares.back))
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

// The normals of both surfaces of this pixel: those from beside it, moved so that their mean is that of the pixel, each as
// far as it is unsure.
void coverage_normals(Coverage shares, out vec3 front, out vec3 back) {
    front = coverage_known(shares.front), back = coverage_known(shares.back);
    float ours = shares.front_share, theirs = 1.0 - ours;
    vec3 left = finite(normal_at(pixel)) - ours * front - theirs * back;
    vec2 moved = vec2(ours * coverage_unsure(shares.front), theirs * coverage_unsure(shares.back));
    left /= ours * moved.x + theirs * moved.y + COVERAGE_NOISE;
    front = unit_normal(front + moved.x * left), back = unit_normal(back + moved.y * left);
}

// The normal of the front surface (k = 0) or of the one behind it, alone.
vec3 coverage_side(Coverage shares, int k) {
    vec3 front, back;
    coverage_normals(shares, front, back);
    return k == 0 ? front : back;
}

// The part of the mean normal of this pixel that is that of the front surface.
vec3 coverage_alone(Coverage shares) {
    return finite(normal_at(pixel)) - (1.0 - shares.front_share) * coverage_side(shares, 1);
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
