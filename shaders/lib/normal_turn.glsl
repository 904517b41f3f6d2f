// How the normal of a surface turns within a pixel, in passes that read `normal`.
//
// On a wire or in a fold a pixel shows many directions of what is mirrored, and one normal only one of them. The length
// of a filtered normal says how far it turns: the variance of its direction is 1 - |N|^2 (Toksvig 2005). The normals
// beside it say where to. So the pixel is shaded at several places, and what that leaves out widens the lobe: slopes of
// the surface and of its microfacets are independent, so that their variances add (Kaplanyan et al. 2016, Tokuyoshi and
// Kaplanyan 2019). Normals of length 1 do not turn, so renders without antialiasing stay as they are.
#include "lib/geometry.glsl"

const int TURN_REACH = 1;   // pixels: how far beside a surface normals are read
const int TURN_PLACES = 4;  // places in a pixel, no two in the same row or column of a 4 x 4 grid
const vec2 TURN_AT[TURN_PLACES] =
    vec2[](vec2(-0.375, -0.125), vec2(-0.125, 0.375), vec2(0.125, -0.375), vec2(0.375, 0.125));
const float TURN_WHOLE = 1.0 / 12.0;  // the variance of places all over a pixel, per axis
// The variance of what one of the four places stands for. Between a quarter of one axis, 1 / 192, which does better on
// pipes, and half of both, 1 / 48, which does better on bumps with a radius of 5 pixels.
const float TURN_PART = 1.0 / 100.0;
const float TURN_MOST = 0.18;  // the most that is added to the square of alpha: that of Tokuyoshi and Kaplanyan
// Normals beside it may tell too little of a turn: steps are lengthened so much, and the variance may be so many times
// what they show. With a limit, a flat surface that another one touches does not count as a bent one.
const float TURN_LONGER = 2.0, TURN_BEYOND = 9.0;
// One place will do while the square of alpha is ten times the variance. A choice, which decides about time.
const float TURN_SMALL = 0.1;

// A normal, what it grows by from one pixel to the next, and the variance that this leaves out.
struct Turn { vec3 normal, across, down; float left; };

// The growth along an axis, on the side where it is less: the other one may be another surface.
vec3 turn_step(ivec2 at, ivec2 way, vec3 normal) {
    vec3 after = unit_normal(normal_at(at + way)), before = unit_normal(normal_at(at - way));
    vec3 ahead = after - normal, behind = normal - before;
    float first = after == vec3(0.0) ? GEOMETRY_FAR : dot(ahead, ahead);
    float second = before == vec3(0.0) ? GEOMETRY_FAR : dot(behind, behind);
    if (min(first, second) == GEOMETRY_FAR) return vec3(0.0);
    return first < second ? ahead : behind;
}

// How `normal` turns, for a surface of this pixel that covers the pixel `at`. Of a pixel that several surfaces share
// the length tells less.
Turn turn_of(ivec2 at, vec3 normal, bool shared_pixel) {
    vec3 filtered = finite(normal_at(at)), middle = unit_normal(filtered);
    vec3 across = turn_step(at, ivec2(1, 0), middle), down = turn_step(at, ivec2(0, 1), middle);
    float steps = TURN_WHOLE * (dot(across, across) + dot(down, down));
    float whole = min(max(1.0 - dot(filtered, filtered), 0.0), (shared_pixel ? 1.0 : TURN_BEYOND) * steps);
    float longer = min(sqrt(whole / max(steps, 1e-12)), TURN_LONGER);
    return Turn(normal, longer * across, longer * down, max(whole - longer * longer * steps, 0.0));
}

// The variance of the turn, in squared radians, over places that have a variance of `part` per axis.
float turn_variance(Turn turn, float part) {
    return turn.left + part * (dot(turn.across, turn.across) + dot(turn.down, turn.down));
}

// The number of places at which a pixel is shaded, for GGX's alpha.
int turn_places(Turn turn, float alpha) {
    return turn_variance(turn, TURN_WHOLE) > TURN_SMALL * alpha * alpha ? TURN_PLACES : 1;
}

// The normal at one of the places.
vec3 turn_normal(Turn turn, int place, int places) {
    if (places == 1) return turn.normal;
    return normalize(turn.normal + TURN_AT[place].x * turn.across + TURN_AT[place].y * turn.down);
}

// How much the light of a place counts: what faces away from the eye cannot be seen.
float turn_weight(vec3 normal, vec3 view) { return dot(normal, view) > 0.0 ? 1.0 : 1e-3; }

// Alpha, widened by the turn between the places.
float turn_alpha(Turn turn, int places, float alpha) {
    float more = turn_variance(turn, places == 1 ? TURN_WHOLE : TURN_PART);
    return sqrt(min(alpha * alpha + min(more, TURN_MOST), 1.0));
}
