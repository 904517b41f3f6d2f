// The filters for places between pixels, by their place among the options of a choice `kernel`. Option 0 is nearest or
// box, which do not weigh pixels by a formula of the distance.

#include "lib/resampling.glsl"

const int FILTER_NEAREST = 0, FILTER_TRIANGLE = 1, FILTER_MITCHELL = 3, FILTER_LANCZOS = 4;

// How many pixels away a filter reaches.
float kernel_radius(int kernel) {
    return kernel == FILTER_TRIANGLE ? 1.0 : kernel == FILTER_LANCZOS ? 3.0 : 2.0;
}

// The weight of a pixel at a distance, not normalized.
float kernel_weight(float x, int kernel) {
    if (kernel == FILTER_TRIANGLE) return triangle_weight(x);
    if (kernel == FILTER_LANCZOS) return lanczos_weight(x, 3.0);
    return kernel == FILTER_MITCHELL ? cubic_weight(x, 1.0 / 3.0, 1.0 / 3.0) : cubic_weight(x, 0.0, 0.5);
}
