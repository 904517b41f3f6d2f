#include "lib/finite.glsl"
#include "lib/kernels.glsl"

const float place_widest = 32.0;  // pixels of the image per pixel; stronger shrinking may alias

// Resamples a picture: pixel p of the result lies at matrix * p + start in the image. `across` and `down` are the rows
// of the matrix.
vec4 place(vec2 across, vec2 down, vec2 start, int kernel) {
    vec2 at = vec2(pixel) + 0.5;
    vec2 center = vec2(dot(across, at), dot(down, at)) + start;
    if (kernel == KERNEL_NEAREST) return image_at(ivec2(floor(center)));
    vec2 width = clamp(vec2(length(across), length(down)), 1.0, place_widest);
    vec2 reach = kernel_radius(kernel) * width;
    ivec2 first = ivec2(floor(center - reach)), last = ivec2(ceil(center + reach));
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int y = first.y; y < last.y; ++y) {
        float row = kernel_weight((float(y) + 0.5 - center.y) / width.y, kernel);
        for (int x = first.x; x < last.x; ++x) {
            float weight = row * kernel_weight((float(x) + 0.5 - center.x) / width.x, kernel);
            sum += weight * image_at(ivec2(x, y));
            total += weight;
        }
    }
    return finite(sum / total);
}
