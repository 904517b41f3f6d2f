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
float nearness_slope(float here, vec2 next_to, vec2 beyond) {
    const float most = 1e9, rounding = 1e-6;
    if (next_to.x <= 0.0 && next_to.y <= 0.0) return 0.0;
    next_to = min(next_to / here, most), beyond = min(beyond / here, most);
    vec2 bend = abs(beyond - 2.0 * next_to + 1.0);
    bend = mix(bend, abs(next_to - 1.0), equal(beyond, vec2(0.0))) + rounding;
    // Where one side has less than a tenth of the bend, it alone counts, else both. A choice: with steps that are a fifth
    // wider 0.3 % of the pixels of the preset wet_floor change by more than 1 / 255.
    float before = bend.x / (bend.x + bend.y);
    float after = 0.5 * (smoothstep(0.1, 0.35, before) + smoothstep(0.65, 0.9, before));
    if (next_to.x <= 0.0) after = 1.0;
    if (next_to.y <= 0.0) after = 0.0;
    return mix(1.0 - next_to.x, next_to.y - 1.0, after);
}
