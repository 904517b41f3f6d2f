#include "lib/display.glsl"

float smaa_tone(vec4 image) { return display_tone(image); }
vec3 smaa_tones(vec4 image) { return srgb_encode(max(straight(finite(image)).rgb, 0.0)); }

float smaa_step(ivec2 a, ivec2 b) { return abs(tone_at(a) - tone_at(b)); }
float smaa_color_step(ivec2 a, ivec2 b) { return largest(abs(tones_at(a) - tones_at(b))); }

// Of the steps to the left and up, those that are edges: not too faint, and no far stronger step beside.
// `after` are the steps to the right and down, `before` those one pixel farther left and up.
vec2 smaa_found(vec2 steps, vec2 after, vec2 before, float threshold, float contrast) {
    vec2 strong = max(steps, max(after, before));
    vec2 least = max(vec2(threshold), max(strong.x, strong.y) / contrast);
    return vec2(steps.x >= least.x && steps.x > 0.0, steps.y >= least.y && steps.y > 0.0);
}

vec2 smaa_edges(float threshold, float contrast) {
    const ivec2 x = ivec2(1, 0), y = ivec2(0, 1);
    return smaa_found(
        vec2(smaa_step(pixel, pixel - x), smaa_step(pixel, pixel - y)),
        vec2(smaa_step(pixel, pixel + x), smaa_step(pixel, pixel + y)),
        vec2(smaa_step(pixel - x, pixel - 2 * x), smaa_step(pixel - y, pixel - 2 * y)), threshold, contrast
    );
}

vec2 smaa_color_edges(float threshold, float contrast) {
    const ivec2 x = ivec2(1, 0), y = ivec2(0, 1);
    return smaa_found(
        vec2(smaa_color_step(pixel, pixel - x), smaa_color_step(pixel, pixel - y)),
        vec2(smaa_color_step(pixel, pixel + x), smaa_color_step(pixel, pixel + y)),
        vec2(smaa_color_step(pixel - x, pixel - 2 * x), smaa_color_step(pixel - y, pixel - 2 * y)), threshold, contrast
    );
}

// Whether an edge lies left of a pixel (axis 0) or above it (axis 1).
bool smaa_edge(ivec2 at, int axis) { return edges_at(at)[axis] > 0.5; }

// What lies below and above the axis under the line between two points, from x to x + 1.
vec2 smaa_area(vec2 from, vec2 to, float x) {
    float first = max(x, from.x), last = min(x + 1.0, to.x);
    if (first >= last) return vec2(0.0);
    vec2 y = from.y + (vec2(first, last) - from.x) / (to.x - from.x) * (to.y - from.y);
    vec2 above = max(y, 0.0), below = max(-y, 0.0), area = 0.5 * vec2(below.x + below.y, above.x + above.y);
    if (y.x * y.y < 0.0) area *= area / (0.5 * abs(y.x - y.y));  // two triangles
    return (last - first) * area;
}

// Short bumps would all but vanish: up to this length they are drawn stronger.
vec2 smaa_bump(vec2 area, float size) { return mix(sqrt(0.5 * area), area, min(size / 32.0, 1.0)); }

// An edge along x with `left` and `right` pixels beside this one. Where other edges leave its ends upward or downward,
// the true line starts half a pixel up or down. Edges to both sides are what the other end's edge is not.
vec2 smaa_line(float left, float right, bvec2 up, bvec2 down) {
    float size = left + right + 1.0;
    vec2 end = 0.5 * (vec2(up) - vec2(down));
    end = vec2(up.x && down.x ? -end.y : end.x, up.y && down.y ? -end.x : end.y);
    if (end.x * end.y < 0.0) return smaa_area(vec2(0.0, end.x), vec2(size, end.y), left);
    vec2 middle = vec2(0.5 * size, 0.0), first = vec2(0.0), last = vec2(0.0);
    if (end.x != 0.0) first = smaa_area(vec2(0.0, end.x), middle, left);
    if (end.y != 0.0) last = smaa_area(middle, vec2(size, end.y), left);
    if (end.x * end.y > 0.0) return smaa_bump(first, size) + smaa_bump(last, size);
    return first + last;
}

// How far an edge that lies on the `axis` side of pixels goes one way, until another crosses or touches it.
int smaa_far(int axis, ivec2 along, bool forward, int reach) {
    ivec2 side = 1 - along, way = forward ? along : -along, at = pixel;
    for (int away = 0; away < reach; ++away) {
        ivec2 seam = forward ? at + along : at;
        if (smaa_edge(seam, 1 - axis) || smaa_edge(seam - side, 1 - axis) || !smaa_edge(at + way, axis)) return away;
        at += way;
    }
    return reach;
}

// The parts of this pixel and of the one across the edge that belong to the other's color.
vec2 smaa_straight(int axis, int reach, float corner_rounding) {
    ivec2 along = axis == 1 ? ivec2(1, 0) : ivec2(0, 1), side = 1 - along;
    int left = smaa_far(axis, along, false, reach), right = smaa_far(axis, along, true, reach);
    ivec2 first = pixel - left * along, last = pixel + (right + 1) * along;
    int cross_axis = 1 - axis;
    bvec2 down = bvec2(smaa_edge(first, cross_axis), smaa_edge(last, cross_axis));
    bvec2 up = bvec2(smaa_edge(first - side, cross_axis), smaa_edge(last - side, cross_axis));
    vec2 area = smaa_line(float(left), float(right), up, down);
    // A crossing edge that goes on for another pixel is a corner of the picture, not a stair of a slanted line.
    vec2 nearer = vec2(left <= right, right <= left);
    nearer *= (1.0 - corner_rounding) / (nearer.x + nearer.y);
    vec2 down_on = vec2(smaa_edge(first + side, cross_axis), smaa_edge(last + side, cross_axis));
    vec2 up_on = vec2(smaa_edge(first - 2 * side, cross_axis), smaa_edge(last - 2 * side, cross_axis));
    return area * (1.0 - vec2(dot(nearer, down_on), dot(nearer, up_on)));
}

// Where the upright part of a stair lies that continues the edge above `at` one way.
ivec2 smaa_upright(ivec2 at, ivec2 way) { return at + ivec2(max(way.x, 0), min(way.y, 0)); }

// How many equal stairs of one pixel an edge above this pixel has one way, and how it goes on after them: 1 for an edge
// upright, 2 for one level; 0 if the end was not found.
ivec2 smaa_stairs(ivec2 way, int reach) {
    ivec2 at = pixel;
    for (int away = 0; away < reach; ++away) {
        bool upright = smaa_edge(smaa_upright(at, way), 0);
        if (!upright || !smaa_edge(at + way, 1))
            return ivec2(away, int(upright) + 2 * int(smaa_edge(at + ivec2(way.x, 0), 1)));
        at += way;
    }
    return ivec2(reach, 0);
}

// The integral of a ramp that is clamped to 0 and 1.
float smaa_ramp(float x) { return x <= 0.0 ? 0.0 : x >= 1.0 ? x - 0.5 : 0.5 * x * x; }

// The part of the unit square about `center` to the right of a rising line.
float smaa_right_of(vec2 from, vec2 to, vec2 center) {
    vec2 d = to - from, away = center - from;
    float steep = max(d.x, d.y), slope = min(d.x, d.y) / steep;
    float middle = 0.5 + (d.y * away.x - d.x * away.y) / steep;
    return (smaa_ramp(middle + 0.5 * slope) - smaa_ramp(middle - 0.5 * slope)) / slope;
}

// Where the line through stairs that rise to the right starts or ends, as `stairs` go on there. It may be known only to
// be one of two places. The pixel below the first stair's edge is that about (1.5, 0.5).
vec2 smaa_start(int on, bool one) { return on == 1 || (on != 2 && !one) ? vec2(1.0, 0.0) : vec2(on == 0 ? 0.0 : 1.0); }
vec2 smaa_end(int on, bool one) { return on == 2 || (on != 1 && !one) ? vec2(1.0, 0.0) : vec2(on == 0 ? 0.0 : 1.0); }

// Both directions of stairs through an edge above this pixel: `rise` is -1 if they rise to the right.
vec2 smaa_diagonal(int rise, int reach) {
    ivec2 before = smaa_stairs(ivec2(-1, -rise), reach), after = smaa_stairs(ivec2(1, rise), reach);
    if (before.x + after.x < 3) return vec2(0.0);
    float left = float(before.x), size = float(before.x + after.x + 1);
    vec2 area = vec2(0.0);
    for (int one = 0; one < 2; ++one) {
        vec2 from = smaa_start(before.y, one == 1), to = smaa_end(after.y, one == 1) + size;
        area += 0.5 * vec2(
            1.0 - smaa_right_of(from, to, left + vec2(1.5, 0.5)), smaa_right_of(from, to, left + vec2(1.5, 1.5))
        );
    }
    return rise < 0 ? area : area.yx;
}

// For the edge above, then the one to the left: the share of this pixel, and of the one across the edge, that belongs to
// the other.
vec4 smaa_weights(int reach, int diagonal, float corner_rounding) {
    vec2 here = edges_at(pixel), above = vec2(0.0), left = vec2(0.0);
    bool sloped = false;
    if (here.y > 0.5) {
        if (diagonal > 0) above = smaa_diagonal(-1, diagonal) + smaa_diagonal(1, diagonal);
        sloped = above.x + above.y > 0.0;
        if (!sloped) above = smaa_straight(1, reach, corner_rounding);
    }
    if (here.x > 0.5 && !sloped) left = smaa_straight(0, reach, corner_rounding);
    return vec4(above, left);
}

// Mixes with neighbors in rows or in columns, on whichever side the edges cut off more.
vec4 smaa() {
    vec4 here = weights_at(pixel), color = image_at(pixel);
    float right = weights_at(pixel + ivec2(1, 0)).w, below = weights_at(pixel + ivec2(0, 1)).y;
    bool level = max(here.z, right) > max(here.x, below);
    ivec2 way = level ? ivec2(1, 0) : ivec2(0, 1);
    vec2 parts = level ? vec2(here.z, right) : vec2(here.x, below);
    float total = parts.x + parts.y;
    if (total <= 0.0) return color;
    vec4 before = image_at(pixel - way), after = image_at(pixel + way);
    parts *= parts / total;
    return color + parts.x * (before - color) + parts.y * (after - color);
}
