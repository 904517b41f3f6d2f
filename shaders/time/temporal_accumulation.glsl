#include "lib/finite.glsl"
#include "lib/geometry.glsl"

const float temporal_accumulation_most = 65504.0;  // the largest half float, which memories hold
const float temporal_accumulation_least = 0.01;    // less of four pixels is no memory (Schied et al. 2017)

vec4 temporal_accumulation_newest(vec4 image) {
    return clamp(finite(image), -temporal_accumulation_most, temporal_accumulation_most);
}

float temporal_accumulation_first(vec4 image) { return 1.0; }

vec4 temporal_accumulation(vec4 mean) { return mean; }

// True if a pixel of the frame before shows the surface of this one.
bool temporal_accumulation_same(ivec2 before, float tolerance, float angle) {
    if (!past_has(before)) return false;
    if (tolerance >= 0.0) {
        float near = nearness(depth_at(pixel)), past = nearness(depth_before_at(before));
        if (abs(past - near) > tolerance * max(past, near)) return false;
    }
    if (angle >= 0.0) {
        vec3 here = unit_normal(normal_at(pixel)), there = unit_normal(normal_before_at(before));
        bool flat_ground = here == vec3(0.0) && there == vec3(0.0);  // the background
        if (!flat_ground && dot(here, there) < cos(angle)) return false;
    }
    return true;
}

// Moves the past toward the mean of the 3 x 3 newest pixels until no channel is farther than `gamma` deviations.
vec4 temporal_accumulation_limit(vec4 past, float gamma) {
    vec4 sum = vec4(0.0), squares = vec4(0.0);
    for (int i = 0; i < 9; ++i) {
        vec4 light = newest_at(pixel + ivec2(i % 3, i / 3) - 1);
        sum += light, squares += light * light;
    }
    vec4 mean = sum / 9.0, reach = gamma * sqrt(max(squares / 9.0 - mean * mean, 0.0));
    return clamp(past, mean - reach, mean + reach);
}

// The mean with this frame, and of how many frames it is.
void temporal_accumulation_mean(
    int frames, float gamma, float tolerance, float angle, out vec4 mean, out float count
) {
    vec4 now = newest_at(pixel), sum = vec4(0.0);
    mean = now, count = 1.0;
    vec2 motion = clamp(finite(velocity_at(pixel).xy) * proxy, -1e6, 1e6), place = vec2(pixel) - motion;
    ivec2 corner = ivec2(floor(place));
    vec2 part = place - floor(place);
    float total = 0.0, age = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 offset = ivec2(i & 1, i >> 1), before = corner + offset;
        vec2 share = mix(1.0 - part, part, vec2(offset));
        float weight = share.x * share.y;
        if (weight <= 0.0 || !temporal_accumulation_same(before, tolerance, angle)) continue;
        sum += weight * past_at(before), age += weight * ages_at(before), total += weight;
    }
    if (total < temporal_accumulation_least) return;
    vec4 past = sum / total;
    if (gamma > 0.0) past = temporal_accumulation_limit(past, gamma);
    count = min(age / total + 1.0, float(frames));
    mean = mix(past, now, 1.0 / count);
}
