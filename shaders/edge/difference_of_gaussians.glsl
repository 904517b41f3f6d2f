#include "lib/display.glsl"

float difference_of_gaussians_tone(vec4 image) { return display_tone(image); }

float difference_of_gaussians_value(float fine, float coarse, int kind, float strength, float epsilon, float phi) {
    if (kind == KIND_DOG) return finite(strength * (fine - coarse));
    float sharp = (1.0 + strength) * fine - strength * coarse;
    return sharp >= epsilon ? 1.0 : 1.0 + tanh(max(phi * (sharp - epsilon), -20.0));
}

// Ink on paper is a tone, so it is turned into light; a difference is neither.
vec4 difference_of_gaussians(vec4 image, float value, int kind) {
    float alpha = finite(image.a);
    return vec4(vec3(kind == KIND_XDOG ? srgb_decode(value) : value) * alpha, alpha);
}
