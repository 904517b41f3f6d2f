// Conventions of data: depth is planar and positive, normals have length 1, and both mark the background.
#include "lib/finite.glsl"

const float GEOMETRY_FAR = 1e9;       // larger depths are background, which renderers write as 1e10 or infinity
const float GEOMETRY_NOTHING = 1e10;  // the depth that nodes write for the background
// Shorter normals count as background. On the sample frame no pixel differs with 0.05.
const float GEOMETRY_LEAST = 0.1;
// Shorter normals are averages of several surfaces (antialiasing): 0.98 is the mean of two that are 23 degrees apart.
const float GEOMETRY_WHOLE = 0.98;

// True for the depth of a surface; false for the background, NaN and infinity.
bool is_surface(float depth) { return is_finite(depth) && depth > 0.0 && depth < GEOMETRY_FAR; }

// 1 / depth, which is linear on every plane; 0 on the background.
float nearness(float depth) { return is_surface(depth) ? 1.0 / depth : 0.0; }

// True for a position on a surface: renderers write the origin for the background.
bool is_place(vec3 position) { return is_finite(position) && position != vec3(0.0); }

// The normal with length 1, which antialiasing may have shortened; 0 on the background.
vec3 unit_normal(vec3 normal) {
    float size = is_finite(normal) ? length(normal) : 0.0;
    return size > GEOMETRY_LEAST && size < GEOMETRY_FAR ? normal / size : vec3(0.0);
}

// True where antialiasing has averaged the normals of several surfaces, and on the background.
bool is_mixed(vec3 normal) { return length(normal) < GEOMETRY_WHOLE; }

// The relative growth of nearness from one pixel to the next, from the pixels one and two steps before and after.
// Nearness is linear on planes: the side where it bends far more than on the other belongs to another surface.
float nearness_slope(float here, vec2 one, vec2 two) {
    const float most = 1e9, rounding = 1e-6;
    if (one.x <= 0.0 && one.y <= 0.0) return 0.0;
    one = min(one / here, most), two = min(two / here, most);
    vec2 bend = abs(two - 2.0 * one + 1.0);
    bend = mix(bend, abs(one - 1.0), equal(two, vec2(0.0))) + rounding;
    float before = bend.x / (bend.x + bend.y);
    float after = 0.5 * (smoothstep(0.1, 0.35, before) + smoothstep(0.65, 0.9, before));
    if (one.x <= 0.0) after = 1.0;
    if (one.y <= 0.0) after = 0.0;
    return mix(1.0 - one.x, one.y - 1.0, after);
}
