#include "lib/color.glsl"
#include "lib/finite.glsl"

float luminance(vec4 image, int measure) {
    vec3 rgb = finite(image.rgb);
    if (measure == MEASURE_AVERAGE) return finite((rgb.r + rgb.g + rgb.b) / 3.0);
    if (measure == MEASURE_MAXIMUM) return largest(rgb);
    if (measure == MEASURE_MINIMUM) return smallest(rgb);
    return finite(luminance(rgb));
}
