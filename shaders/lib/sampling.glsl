// Pictures between their pixels, by the filters of lib/kernels.glsl.

#include "lib/kernels.glsl"

// The picture between its pixels, in a pass that reads `image`, by the filter of a choice `kernel`. Where pixels lie
// closer together in the image than in the result, average several of these: see lib/footprint.glsl.
vec4 image_filtered(vec2 at, int kernel) {
    at = clamp(at, -16777216.0, 16777216.0);
    if (kernel == FILTER_NEAREST) return image_at(ivec2(floor(at)));
    if (kernel == FILTER_TRIANGLE) return image_near(at);
    int taps = 2 * int(kernel_radius(kernel));
    ivec2 first = ivec2(floor(at - 0.5)) - taps / 2 + 1;
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < taps * taps; ++i) {
        ivec2 p = first + ivec2(i % taps, i / taps);
        vec2 away = vec2(p) + 0.5 - at;
        float weight = kernel_weight(away.x, kernel) * kernel_weight(away.y, kernel);
        sum += weight * image_at(p);
        total += weight;
    }
    return sum / total;
}
