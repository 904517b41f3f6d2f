#include "lib/adaptation.glsl"
#include "lib/color.glsl"

// Bin b of the histogram is at 2^(first + step b).
const float auto_exposure_first = -16.0, auto_exposure_step = 0.25, auto_exposure_last = 127.0;

// The luminance of a pixel, and its weight.
vec2 auto_exposure_light(vec4 image, float mask, float center_weight, vec2 center, float radius) {
    vec4 light = metered(image);
    vec2 off = (vec2(pixel) + 0.5 - center * vec2(extent)) / max(radius, 1e-3);
    float spot = 1.0 - center_weight * (1.0 - exp(-0.5 * dot(off, off)));
    return vec2(luminance(light.rgb), light.a * clamp(finite(mask), 0.0, 1e6) * spot);
}

// The terms of the sums: light, its logarithm, and the weight.
vec3 auto_exposure_terms(vec2 light) { return light.y * vec3(light.x, log(light.x + 1e-5), 1.0); }

float auto_exposure_mean(vec3 sums, int metering) {
    if (sums.z <= 0.0) return 0.0;
    return metering == METERING_AVERAGE ? sums.x / sums.z : exp(sums.y / sums.z);
}

float auto_exposure_peak(vec2 light) { return light.y > 0.0 ? light.x : 0.0; }

float auto_exposure_maximum(float peak) { return peak; }

// The place of a pixel among the bins, and its weight.
vec2 auto_exposure_place(vec2 light) {
    float stop = log2(max(light.x, 1e-9));
    return vec2(clamp((stop - auto_exposure_first) / auto_exposure_step, 0.0, auto_exposure_last), light.y);
}

// Four bins of the histogram of one row.
vec4 auto_exposure_row(int first, int end) {
    vec4 bins = float(4 * pixel.x) + vec4(0.0, 1.0, 2.0, 3.0), sum = vec4(0.0);
    for (int x = first; x < end; ++x) {
        vec2 placed = place_at(ivec2(x, pixel.y));
        sum += placed.y * max(1.0 - abs(placed.x - bins), 0.0);
    }
    return sum;
}

vec4 auto_exposure_both() { return one_at(pixel) + other_at(pixel); }

vec4 auto_exposure_fold(int count) {
    vec4 sum = vec4(0.0);
    int end = min((pixel.y + 1) * count, table_size.y);
    for (int y = pixel.y * count; y < end; ++y) sum += table_at(ivec2(pixel.x, y));
    return sum;
}

// The geometric mean of the light between two percentiles. A bin counts by its part between them.
float auto_exposure_percentiles(float low, float high) {
    vec4 sums = vec4(0.0);
    for (int x = 0; x < table_size.x; ++x) sums += table_at(ivec2(x, 0));
    float total = dot(sums, vec4(1.0)), below = 0.0, inside = 0.0, stops = 0.0;
    if (total <= 0.0) return 0.0;
    for (int x = 0; x < table_size.x; ++x) {
        vec4 bins = table_at(ivec2(x, 0)) / total;
        for (int i = 0; i < 4; ++i) {
            float part = clamp(below + bins[i], low, high) - clamp(below, low, high);
            below += bins[i];
            inside += part;
            stops += part * float(4 * x + i);
        }
    }
    return exp2(auto_exposure_first + auto_exposure_step * stops / max(inside, 1e-9));
}

float auto_exposure_stops(
    float average, int metering, float key, bool auto_key, float nits, float compensation, float minimum, float maximum
) {
    if (average <= 0.0) return compensation;
    if (auto_key) key = natural_key(average * nits);
    float target = metering == METERING_MAXIMUM ? 1.0 : key;
    return clamp(log2(target / average), minimum, maximum) + compensation;
}

vec4 auto_exposure(vec4 image, float exposure) { return finite(vec4(finite(image.rgb) * exp2(exposure), image.a)); }
