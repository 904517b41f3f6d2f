#include "lib/camera.glsl"
#include "lib/geometry.glsl"

vec3 curvature_place(float depth, vec4 rays[3]) {
    return is_surface(depth) ? camera_place(rays, camera_uv(pixel, extent), depth) : vec3(0.0);
}

// Mean curvature: half the trace of the shape operator (do Carmo 1976). `across` and `down` are the steps of the
// position, `turn_across` and `turn_down` those of the normal.
float curvature_mean(vec3 across, vec3 down, vec3 turn_across, vec3 turn_down) {
    float e = dot(across, across), f = dot(across, down), g = dot(down, down), area = e * g - f * f;
    float l = dot(turn_across, across), n = dot(turn_down, down);
    float m = 0.5 * (dot(turn_across, down) + dot(turn_down, across));
    return area > 1e-6 * e * g ? finite(0.5 * (l * g - 2.0 * m * f + n * e) / area) : 0.0;
}

bool curvature_inside(ivec2 at) { return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, extent)); }

// True if there is a gap between two pixels: the step is more than twice as long as both steps beside it. The step
// across a fold is between those two in length.
bool curvature_gap(float before, float here, float after) {
    before = before < GEOMETRY_FAR ? before : 0.0;
    after = after < GEOMETRY_FAR ? after : 0.0;
    return here >= GEOMETRY_FAR || here > 2.0 * max(before, after);
}

// How position and normal change along a line of pixels: from one neighbor to the other, or from the pixel itself where
// a gap is in between. A neighbor whose normal is a mixture of several surfaces is used across a fold, but not beside a
// gap.
bool curvature_change(ivec2 along, out vec3 way, out vec3 turn) {
    float steps[6];
    vec3 last = vec3(0.0);
    for (int i = -3; i <= 3; ++i) {
        ivec2 at = pixel + i * along;
        vec3 place = curvature_inside(at) ? places_at(at) : vec3(0.0);
        if (i > -3) steps[i + 2] = is_place(last) && is_place(place) ? distance(last, place) : GEOMETRY_FAR;
        last = place;
    }
    ivec2 before = pixel - along, after = pixel + along;
    bool back = !curvature_gap(steps[1], steps[2], steps[3]), on = !curvature_gap(steps[2], steps[3], steps[4]);
    if (is_mixed(normal_at(before)) && curvature_gap(steps[0], steps[1], steps[2])) back = false;
    if (is_mixed(normal_at(after)) && curvature_gap(steps[3], steps[4], steps[5])) on = false;
    if (!back) before = pixel;
    if (!on) after = pixel;
    vec3 first = unit_normal(normal_at(before)), second = unit_normal(normal_at(after));
    way = places_at(after) - places_at(before);
    turn = second - first;
    if (first == vec3(0.0) || second == vec3(0.0)) return false;
    return is_mixed(normal_at(pixel)) ? back && on : back || on;
}

float curvature_found(int reach) {
    vec3 across, down, turn_across, turn_down;
    if (!is_place(places_at(pixel)) || unit_normal(normal_at(pixel)) == vec3(0.0)) return 0.0;
    if (!curvature_change(ivec2(reach, 0), across, turn_across)) return 0.0;
    if (!curvature_change(ivec2(0, reach), down, turn_down)) return 0.0;
    return curvature_mean(across, down, turn_across, turn_down);
}

// The least cosine between a surface and the view: at 87 degrees. With half or twice the number no pixel of the
// built-in scene `stage` changes.
const float curvature_grazing = 0.05;

// The vector on a surface, seen along `forward`, to the point that lies `beside` it in the picture.
vec3 curvature_way(vec3 normal, vec3 beside, vec3 forward) {
    return beside - forward * (dot(normal, beside) / min(dot(normal, forward), -curvature_grazing));
}

float curvature_alone(int reach, vec3 right, vec3 down, vec3 forward) {
    vec3 normal = unit_normal(normal_at(pixel)), ends[4];
    if (normal == vec3(0.0)) return 0.0;
    ivec2 steps[4] = ivec2[4](ivec2(-reach, 0), ivec2(reach, 0), ivec2(0, -reach), ivec2(0, reach)), spans = ivec2(0);
    for (int i = 0; i < 4; ++i) {
        ivec2 at = pixel + steps[i];
        ends[i] = unit_normal(normal_at(at));
        bool there = ends[i] != vec3(0.0) && curvature_inside(at);
        if (!there) ends[i] = normal;
        else spans[i / 2] += reach;
    }
    if (spans.x == 0 || spans.y == 0) return 0.0;
    vec3 across = curvature_way(normal, right, forward), below = curvature_way(normal, down, forward);
    vec2 span = vec2(spans) / float(extent.y);
    return curvature_mean(across * span.x, below * span.y, ends[1] - ends[0], ends[3] - ends[2]);
}

float curvature(float mean, float radius) { return clamp(mean * radius, 0.0, 1.0); }
