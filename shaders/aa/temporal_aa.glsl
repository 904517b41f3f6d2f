#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/geometry.glsl"
#include "lib/resampling.glsl"

// Samples are mixed as c / (1 + luminance). This is the same as giving each the weight 1 / (1 + luminance) (Karis
// 2014), which keeps small bright lights from flickering.
const float temporal_aa_most = 65504.0;  // the largest half float: samples are clamped to it
const float temporal_aa_rounding = 1e-3;  // least deviation: rounding noise in a flat channel must not hide the past

const float temporal_aa_moving = 0.25;  // least share of the new frame in motion: reads between pixels blur

// RGB to YCoCg: luma, orange-blue and green-magenta (Malvar and Sullivan 2003).
vec3 temporal_aa_mixed(vec3 rgb) {
    return vec3(dot(rgb, vec3(0.25, 0.5, 0.25)), 0.5 * (rgb.r - rgb.b), dot(rgb, vec3(-0.25, 0.5, -0.25)));
}

// A pixel in the form in which samples are mixed, with its alpha.
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

// The pixel of 3 x 3 that is nearest to the camera. Its motion is used, so that the antialiased edge moves with the
// object in front.
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

// True if the surface of this pixel was visible near `place` in the frame before.
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

// The frame before at a place between pixels, resampled; exact at pixel centers. `brightest` rises to the largest
// luminance that is read.
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
    if (!history_has(ivec2(floor(place)))) return now;
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
    // The past is moved toward the mean until all channels are within reach. All channels move together, so that no new
    // color appears.
    vec4 off = temporal_aa_past(place, kernel, brightest) - mean, over = abs(off) / reach;
    float farthest = max(max(over.x, over.y), max(over.z, over.w));
    share = mix(share, max(share, temporal_aa_moving), min(2.0 * length(motion), 1.0));
    vec4 mixed = mix(mean + off / max(farthest, 1.0), now, share);
    // Weighted light close to 1 stands for almost infinite light. So the result is never brighter than the brightest
    // sample that was read, and never negative.
    vec3 rgb = max(temporal_aa_rgb(mixed), darkest);
    mixed.xyz = temporal_aa_mixed(rgb * min(1.0, brightest / max(luminance(rgb), 1e-6)));
    // Where the whole neighborhood is transparent, the past adds no coverage.
    mixed.w = squares.w == 0.0 ? 0.0 : clamp(mixed.w, 0.0, 1.0);
    return mixed;
}
