#include "lib/display.glsl"

float smaa_tone(vec4 image) { return display_tone(image); }
vec3 smaa_tones(vec4 image) { return srgb_encode(max(straight(finite(image)).rgb, 0.0)); }

float smaa_step(ivec2 a, ivec2 b) { return abs(tone_at(a) - tone_at(b)); }
float smaa_color_step(ivec2 a, ivec2 b) { return largest(abs(tones_at(a) - tones_at(b))); }

// Whether there is an edge at the left (x) and at the top (y) of a pixel: the step of tone there is above the
// threshold, and no neighboring step is `contrast` times as large (local contrast adaptation, Jimenez et al. 2012).
// `steps` are to the left and up, `after` to the right and down, `before` one pixel farther left and up.
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

// True if there is an edge at the left of a pixel (axis 0) or at its top (axis 1).
bool smaa_edge(ivec2 at, int axis) { return edges_at(at)[axis] > 0.5; }

// The areas below (x) and above (y) the axis that a line between two points encloses, from x to x + 1.
vec2 smaa_area(vec2 from, vec2 to, float x) {
    float first = max(x, from.x), last = min(x + 1.0, to.x);
    if (first >= last) return vec2(0.0);
    vec2 y = from.y + (vec2(first, last) - from.x) / (to.x - from.x) * (to.y - from.y);
    vec2 above = max(y, 0.0), below = max(-y, 0.0), area = 0.5 * vec2(below.x + below.y, above.x + above.y);
    if (y.x * y.y < 0.0) area *= area / (0.5 * abs(y.x - y.y));  // the line crosses the axis: two triangles
    return (last - first) * area;
}

// Makes the areas of short U shapes larger, since they are hardly visible otherwise. From a length of 32 pixels on they
// stay as they are. As in the area texture of the SMAA authors.
vec2 smaa_bump(vec2 area, float size) { return mix(sqrt(0.5 * area), area, min(size / 32.0, 1.0)); }

// Areas of an edge along x that goes on for `left` and `right` pixels beside this one. `up` and `down` say whether
// edges leave its two ends upward or downward: there the true line starts half a pixel up or down. An end with edges on
// both sides takes the direction opposite to the other end.
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

// The length of an edge at the `axis` side of pixels in one direction, until another edge crosses or touches it.
int smaa_far(int axis, ivec2 along, bool forward, int reach) {
    ivec2 side = 1 - along, way = forward ? along : -along, at = pixel;
    for (int away = 0; away < reach; ++away) {
        ivec2 seam = forward ? at + along : at;
        if (smaa_edge(seam, 1 - axis) || smaa_edge(seam - side, 1 - axis) || !smaa_edge(at + way, axis)) return away;
        at += way;
    }
    return reach;
}

// The parts of this pixel and of the pixel across the edge that take the color of the other one.
vec2 smaa_straight(int axis, int reach, float corner_rounding) {
    ivec2 along = axis == 1 ? ivec2(1, 0) : ivec2(0, 1), side = 1 - along;
    int left = smaa_far(axis, along, false, reach), right = smaa_far(axis, along, true, reach);
    ivec2 first = pixel - left * along, last = pixel + (right + 1) * along;
    int cross_axis = 1 - axis;
    bvec2 down = bvec2(smaa_edge(first, cross_axis), smaa_edge(last, cross_axis));
    bvec2 up = bvec2(smaa_edge(first - side, cross_axis), smaa_edge(last - side, cross_axis));
    vec2 area = smaa_line(float(left), float(right), up, down);
    // A crossing edge that is longer than one pixel is a corner of an object, not a stair of a slanted line.
    vec2 nearer = vec2(left <= right, right <= left);
    nearer *= (1.0 - corner_rounding) / (nearer.x + nearer.y);
    vec2 down_on = vec2(smaa_edge(first + side, cross_axis), smaa_edge(last + side, cross_axis));
    vec2 up_on = vec2(smaa_edge(first - 2 * side, cross_axis), smaa_edge(last - 2 * side, cross_axis));
    return area * (1.0 - vec2(dot(nearer, down_on), dot(nearer, up_on)));
}

// The pixel at whose left side the stair goes on, from the edge above `at` in one direction.
ivec2 smaa_upright(ivec2 at, ivec2 way) { return at + ivec2(max(way.x, 0), min(way.y, 0)); }

// The number of stairs of one pixel that follow the edge above this pixel in one direction, and how the edge goes on
// after them: 1 vertical, 2 horizontal, 3 both, 0 neither, or not found within `reach`.
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

// The integral of a ramp that is clamped to 0..1.
float smaa_ramp(float x) { return x <= 0.0 ? 0.0 : x >= 1.0 ? x - 0.5 : 0.5 * x * x; }

// The part of the unit square around `center` that lies to the right of a rising line.
float smaa_right_of(vec2 from, vec2 to, vec2 center) {
    vec2 d = to - from, away = center - from;
    float steep = max(d.x, d.y), slope = min(d.x, d.y) / steep;
    float middle = 0.5 + (d.y * away.x - d.x * away.y) / steep;
    return (smaa_ramp(middle + 0.5 * slope) - smaa_ramp(middle - 0.5 * slope)) / slope;
}

// Where the line through rising stairs starts and ends, depending on how the edge goes on there. Where that is
// ambiguous there are two candidates, chosen by `upper`, and the areas are averaged. The pixel below the first stair has
// its center at (1.5, 0.5).
vec2 smaa_start(int on, bool upper) { return on == 1 || (on != 2 && !upper) ? vec2(1.0, 0.0) : vec2(on == 0 ? 0.0 : 1.0); }
vec2 smaa_end(int on, bool upper) { return on == 2 || (on != 1 && !upper) ? vec2(1.0, 0.0) : vec2(on == 0 ? 0.0 : 1.0); }

// The areas of the diagonal through the edge above this pixel. `rise` is -1 for stairs that rise to the right, 1 for
// stairs that fall.
vec2 smaa_diagonal(int rise, int reach) {
    ivec2 before = smaa_stairs(ivec2(-1, -rise), reach), after = smaa_stairs(ivec2(1, rise), reach);
    if (before.x + after.x < 3) return vec2(0.0);
    float left = float(before.x), size = float(before.x + after.x + 1);
    vec2 area = vec2(0.0);
    for (int candidate = 0; candidate < 2; ++candidate) {
        vec2 from = smaa_start(before.y, candidate == 1), to = smaa_end(after.y, candidate == 1) + size;
        area += 0.5 * vec2(
            1.0 - smaa_right_of(from, to, left + vec2(1.5, 0.5)), smaa_right_of(from, to, left + vec2(1.5, 1.5))
        );
    }
    return rise < 0 ? area : area.yx;
}

// How much of this pixel and of the pixel across the edge takes the color of the other one: xy for the edge at the top,
// zw for the edge at the left.
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

// Mixes a pixel with its neighbors in its row or in its column, whichever has the larger weights.
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
