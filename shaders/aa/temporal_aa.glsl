#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/geometry.glsl"
#include "lib/resampling.glsl"

// Samples are mixed as c / (1 + luminance): that is the same as to weigh them by 1 / (1 + luminance) (Karis 2014).
const float temporal_aa_most = 65504.0;  // no sample is brighter
const float temporal_aa_rounding = 1e-3;  // where a channel is flat, rounding must not hold the others

const float temporal_aa_moving = 0.25;  // where pixels move, what is read between them softens: a shorter past is sharper

// Luma, orange and green (YCoCg, Malvar and Sullivan 2003).
vec3 temporal_aa_mixed(vec3 rgb) {
    return vec3(dot(rgb, vec3(0.25, 0.5, 0.25)), 0.5 * (rgb.r - rgb.b), dot(rgb, vec3(-0.25, 0.5, -0.25)));
}

// A sample as it is mixed, and alpha.
vec4 temporal_aa_sample(vec4 image, bool weigh_light) {
    vec4 safe = clamp(finite(image), -temporal_aa_most, temporal_aa_most);
    vec3 rgb = safe.rgb;
    if (weigh_light) rgb /= 1.0 + max(luminance(rgb), 0.0);
    return vec4(temporal_aa_mixed(rgb), safe.a);
}

vec3 temporal_aa_rgb(vec4 mixed) {
    float rest = mixed.x - mixed.z;
    return vec3(rest + mixed.y, mixed.x + mixed.z, rest - mixed.y);
}

vec4 temporal_aa(vec4 blended, bool weigh_light) {
    vec3 rgb = temporal_aa_rgb(blended);
    if (weigh_light) rgb /= max(1.0 - luminance(rgb), 1.0 / (1.0 + temporal_aa_most));
    return finite(vec4(rgb, blended.a));
}

// The nearest of 3 x 3 pixels: its edge is smooth only if all that it touches moves with it.
ivec2 temporal_aa_front() {
    ivec2 front = pixel;
    float nearest = nearness(depth_at(pixel));
    for (int i = 0; i < 9; ++i) {
        ivec2 at = pixel + ivec2(i % 3, i / 3) - 1;
        float near = nearness(depth_at(at));
        if (near > nearest) nearest = near, front = at;
    }
    return front;
}

// True if what is seen here was seen around `place` in the frame before.
bool temporal_aa_known(vec2 place, float tolerance) {
    float near = nearness(depth_at(pixel));
    for (int i = 0; i < 9; ++i) {
        float past = nearness(depth_before_at(ivec2(floor(place)) + ivec2(i % 3, i / 3) - 1));
        if (abs(past - near) <= tolerance * max(past, near)) return true;
    }
    return false;
}

float temporal_aa_weight(float away, int kernel) {
    return kernel == KERNEL_LANCZOS ? lanczos_weight(away, 3.0) : cubic_weight(away, 0.0, 0.5);
}

// The past between pixels; as it is where nothing moves. `brightest` is raised to what is read.
vec4 temporal_aa_past(vec2 place, int kernel, inout float brightest) {
    int reach = kernel == KERNEL_LANCZOS ? 3 : 2;
    ivec2 corner = ivec2(floor(place - 0.5));
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int y = 1 - reach; y <= reach; ++y) {
        float row = temporal_aa_weight(float(corner.y + y) + 0.5 - place.y, kernel);
        for (int x = 1 - reach; x <= reach; ++x) {
            float weight = row * temporal_aa_weight(float(corner.x + x) + 0.5 - place.x, kernel);
            vec4 light = history_at(corner + ivec2(x, y));
            sum += weight * light;
            total += weight;
            if (weight > 0.0) brightest = max(brightest, luminance(temporal_aa_rgb(light)));
        }
    }
    return sum / total;
}

vec4 temporal_aa_blend(float share, float gamma, float tolerance, bool deep, int kernel) {
    vec4 now = sample_at(pixel);
    ivec2 front = deep ? temporal_aa_front() : pixel;
    vec2 motion = clamp(finite(velocity_at(front).xy) * proxy, -1e6, 1e6), place = vec2(pixel) + 0.5 - motion;
    if (any(lessThan(place, vec2(0.0))) || any(greaterThan(place, vec2(extent)))) return now;
    if (deep && !temporal_aa_known(place, tolerance)) return now;

    vec4 sum = vec4(0.0), squares = vec4(0.0);
    float brightest = 0.0;
    vec3 darkest = vec3(0.0);
    for (int i = 0; i < 9; ++i) {
        vec4 light = sample_at(pixel + ivec2(i % 3, i / 3) - 1);
        sum += light, squares += light * light;
        brightest = max(brightest, luminance(temporal_aa_rgb(light)));
        darkest = min(darkest, temporal_aa_rgb(light));
    }
    vec4 mean = sum / 9.0, reach = gamma * sqrt(max(squares / 9.0 - mean * mean, 0.0));
    reach = max(reach, temporal_aa_rounding * max(abs(mean.x), 1.0));
    // Towards the mean until all channels are within reach, so that no color appears that was in neither.
    vec4 off = temporal_aa_past(place, kernel, brightest) - mean, over = abs(off) / reach;
    float farthest = max(max(over.x, over.y), max(over.z, over.w));
    share = mix(share, max(share, temporal_aa_moving), min(2.0 * length(motion), 1.0));
    vec4 mixed = mix(mean + off / max(farthest, 1.0), now, share);
    // Near 1, weighed light becomes light without end: it gets no brighter than all that it is made of, and not negative.
    vec3 rgb = max(temporal_aa_rgb(mixed), darkest);
    mixed.xyz = temporal_aa_mixed(rgb * min(1.0, brightest / max(luminance(rgb), 1e-6)));
    // Where everything around is empty, the past adds no coverage.
    mixed.w = squares.w == 0.0 ? 0.0 : clamp(mixed.w, 0.0, 1.0);
    return mixed;
}
