// Selects bright light, and adds glow to a picture. The functions up to bright_power() return the light to keep, from
// the luminance (or another measure) of a pixel.
#include "lib/color.glsl"
#include "lib/finite.glsl"

const float BRIGHT_NONE = 1e-5;  // least luminance to divide by

// Hard threshold: all light above it, nothing below.
float bright_hard(float light, float threshold) { return light > threshold ? light : 0.0; }

// Soft threshold: the light above it, with a quadratic transition whose width is `knee` times the threshold.
float bright_soft(float light, float threshold, float knee) {
    float above = light - threshold, width = threshold * knee;
    float eased = clamp(above + width, 0.0, 2.0 * width);
    return max(eased * eased / (4.0 * width + BRIGHT_NONE), above);
}

// Keeps all light far above the threshold and little of the light below it.
float bright_exponential(float light, float threshold, float power) {
    return light * (1.0 - exp(-pow(light / max(threshold, BRIGHT_NONE), power)));
}

// Light times a power of light / threshold: light at the threshold stays as it is.
float bright_power(float light, float threshold, float power) {
    return light * pow(light / max(threshold, BRIGHT_NONE), power);
}

// The light of a picture that glows: above a soft threshold, and not brighter than the limit. Hue and alpha stay.
vec4 bright_light(vec4 image, float threshold, float knee, float limit) {
    vec4 safe = finite(image);
    float light = luminance(safe.rgb);
    if (light <= 0.0) return vec4(0.0, 0.0, 0.0, safe.a);
    return vec4(safe.rgb * (bright_soft(min(light, limit), threshold, knee) / light), safe.a);
}

// The glow alone, with the alpha of its picture.
vec4 glow_alone(vec4 image, vec3 glow) { return vec4(glow, finite(image.a)); }

// Adds light to a picture. Light covers nothing, so alpha stays.
vec4 with_glow(vec4 image, vec3 glow) {
    vec4 safe = finite(image);
    return vec4(safe.rgb + glow, safe.a);
}
