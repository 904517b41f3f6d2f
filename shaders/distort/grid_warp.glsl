#include "lib/finite.glsl"
#include "lib/footprint.glsl"
#include "lib/sampling.glsl"

const int grid_warp_rounds = 10;
const float grid_warp_missed = 0.02;  // in pixels: a place that is farther off was not found
const vec3 grid_warp_nowhere = vec3(0.0, 0.0, -1.0);

// What each of four points in a row counts at t, from 0 to 3, and how fast that changes. Beyond the ends it is linear.
void grid_warp_weigh(float t, int interpolation, out vec4 weights, out vec4 slopes) {
    float inside = clamp(t, 0.0, 3.0), cell = min(floor(inside), 2.0), f = inside - cell, g = 1.0 - f;
    vec4 order = vec4(0.0, 1.0, 2.0, 3.0);
    vec4 lower = vec4(equal(order, vec4(cell))), upper = vec4(equal(order, vec4(cell + 1.0)));
    weights = g * lower + f * upper;
    slopes = upper - lower;
    if (interpolation == INTERPOLATION_SMOOTH) {
        // The second derivatives at the points of a natural cubic spline, which are 0 at both ends.
        vec4 second = vec4(1.6, -3.6, 2.4, -0.4), third = second.wzyx;
        vec4 here = cell == 1.0 ? second : cell == 2.0 ? third : vec4(0.0);
        vec4 next = cell == 0.0 ? second : cell == 1.0 ? third : vec4(0.0);
        weights += ((g * g * g - g) * here + (f * f * f - f) * next) / 6.0;
        slopes += ((1.0 - 3.0 * g * g) * here + (3.0 * f * f - 1.0) * next) / 6.0;
    }
    weights += (t - inside) * slopes;
}

// Where a place on the grid goes, in pixels, and the derivative by columns.
vec2 grid_warp_place(vec2 t, int interpolation, const vec4 across[4], const vec4 down[4], out mat2 slope) {
    vec4 u, v, u_slope, v_slope;
    grid_warp_weigh(t.x, interpolation, u, u_slope);
    grid_warp_weigh(t.y, interpolation, v, v_slope);
    vec2 place = vec2(0.0);
    slope = mat2(0.0);
    for (int row = 0; row < 4; ++row) {
        vec2 point = vec2(dot(across[row], u), dot(down[row], u));
        place += v[row] * point;
        slope[0] += v[row] * vec2(dot(across[row], u_slope), dot(down[row], u_slope));
        slope[1] += v_slope[row] * point;
    }
    slope = mat2(slope[0] * vec2(extent), slope[1] * vec2(extent));
    return place * vec2(extent);
}

// The pixel of the image that goes to a place, and 1; the third number is below 0 where there is none.
vec3 grid_warp_source(vec2 at, int interpolation, const vec4 across[4], const vec4 down[4], out mat2 slope) {
    vec2 t = vec2(0.0);
    float nearest = 3e38;
    for (int i = 0; i < starts_size.x; ++i) {
        vec4 start = starts_at(ivec2(i, 0));
        vec2 away = (start.xy - at / vec2(extent)) * vec2(extent);
        float square = dot(away, away);
        if (square < nearest) {
            nearest = square;
            t = start.zw;
        }
    }
    vec2 away = vec2(0.0);
    for (int i = 0; i < grid_warp_rounds; ++i) {
        away = at - grid_warp_place(t, interpolation, across, down, slope);
        float area = determinant(slope);
        if (abs(area) < 1e-6) return grid_warp_nowhere;
        vec2 newton_step = vec2(slope[1].y * away.x - slope[1].x * away.y, slope[0].x * away.y - slope[0].y * away.x) / area;
        // Long steps leave the part of the grid where the derivative says anything; outside all is straight.
        bool is_inside = all(greaterThan(t, vec2(0.0))) && all(lessThan(t, vec2(3.0)));
        float step_length = length(newton_step);
        t += is_inside && step_length > 0.5 ? newton_step * (0.5 / step_length) : newton_step;
        if (any(greaterThan(abs(t), vec2(1e4)))) return grid_warp_nowhere;
    }
    away = at - grid_warp_place(t, interpolation, across, down, slope);
    if (dot(away, away) > grid_warp_missed * grid_warp_missed || abs(determinant(slope)) < 1e-6) return grid_warp_nowhere;
    slope = inverse(slope);
    vec2 cell = vec2(image_size) / 3.0;
    slope = mat2(slope[0] * cell, slope[1] * cell);
    return vec3(t * cell, 1.0);
}

vec4 grid_warp(const vec4 across[4], const vec4 down[4], int interpolation, int kernel) {
    mat2 slope;
    vec2 at = vec2(pixel) + 0.5;
    vec3 here = grid_warp_source(at, interpolation, across, down, slope);
    if (here.z < 0.0) return vec4(0.0);
    int n = footprint_samples(slope[0], slope[1]);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i) sum += image_filtered(here.xy + slope * footprint_at(i, n), kernel);
    return finite(sum / float(n * n));
}
