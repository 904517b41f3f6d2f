#include "lib/finite.glsl"
#include "lib/kernels.glsl"

// Resamples along one axis. `shrink` is how many pixels of the image one pixel of the result spans.
vec4 resize(int axis, float shrink, int kernel) {
    bool box = kernel == KERNEL_BOX;
    float center = (float(pixel[axis]) + 0.5) * shrink, width = max(shrink, 1.0);
    float reach = box ? 0.5 * shrink : kernel_radius(kernel) * width;
    float low = center - reach, high = center + reach;
    ivec2 at = pixel;
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = int(floor(low)); i < int(ceil(high)); ++i) {
        at[axis] = i;
        // The box filter weighs each pixel by the part of it that lies inside.
        float weight = box ? min(float(i) + 1.0, high) - max(float(i), low)
                           : kernel_weight((float(i) + 0.5 - center) / width, kernel);
        sum += weight * image_at(at);
        total += weight;
    }
    return finite(sum / total);
}
