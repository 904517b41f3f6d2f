#include "lib/finite.glsl"
#include "lib/geometry.glsl"

// How much nearer picture a is than b; above 0 a is in front.
float depth_merge_lead(ivec2 at) { return nearness(a_depth_at(at)) - nearness(b_depth_at(at)); }

// How the lead changes along an axis: on the side where it changes less, which shows the same two surfaces. The other
// side may lie across a silhouette, which the pictures antialias.
float depth_merge_slope(float here, ivec2 along) {
    float ahead = depth_merge_lead(pixel + along) - here, behind = here - depth_merge_lead(pixel - along);
    return abs(ahead) < abs(behind) ? ahead : behind;
}

// The part of a pixel on the positive side of a line, from its value at the center and its slope: the area of a square
// that is cut by a line.
float depth_merge_share(float value, vec2 slope) {
    vec2 steep = abs(slope);
    float larger = max(steep.x, steep.y), smaller = min(steep.x, steep.y);
    float corner = 0.5 * (larger + smaller), away = abs(value);
    if (away >= corner || larger <= 0.0) return value > 0.0 ? 1.0 : 0.0;
    float flat_part = 0.5 * (larger - smaller);
    float rest = away <= flat_part ? 0.5 - away / larger
                                   : 0.5 * (corner - away) * (corner - away) / max(larger * smaller, 1e-30);
    return value > 0.0 ? 1.0 - rest : rest;
}

void depth_merge(bool antialias, out vec4 result, out float depth) {
    float lead = depth_merge_lead(pixel), share = lead > 0.0 ? 1.0 : 0.0;
    vec4 first = finite(a_at(pixel)), second = finite(b_at(pixel));
    if (antialias) {
        vec2 slope = vec2(depth_merge_slope(lead, ivec2(1, 0)), depth_merge_slope(lead, ivec2(0, 1)));
        share = depth_merge_share(lead, slope);
    }
    vec4 front = first + second * (1.0 - clamp(first.a, 0.0, 1.0)), back = second + first * (1.0 - clamp(second.a, 0.0, 1.0));
    result = finite(mix(back, front, share));
    float near = max(nearness(a_depth_at(pixel)), nearness(b_depth_at(pixel)));
    depth = near > 0.0 ? 1.0 / near : GEOMETRY_NOTHING;
}
