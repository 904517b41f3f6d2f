#include "lib/finite.glsl"
#include "lib/spectrum.glsl"

// The lens shifts red outward, so a pixel reads its red light nearer to the center.
vec4 chromatic_aberration(int shape, float amount, float angle, int samples, vec2 center) {
    vec2 at = vec2(pixel) + 0.5;
    float unit = 0.5 * float(extent.y);
    vec2 spread = amount * (shape == SHAPE_RADIAL ? (at - center) / unit : vec2(cos(angle), sin(angle)));
    vec4 sum = vec4(0.0), total = vec4(0.0);
    for (int i = 0; i < samples; ++i) {
        float place = 2.0 * float(i) / float(samples - 1) - 1.0;
        vec4 response = spectrum_response(place);
        sum += response * image_near(at + place * spread);
        total += response;
    }
    return finite(sum / total);
}
