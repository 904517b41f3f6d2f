#include "lib/display.glsl"

// Levels include 0 and 1. The tone changes fastest in the middle between two levels.
float toon_tone(float tone, float levels, float sharpness) {
    float step_size = 1.0 / (max(levels, 2.0) - 1.0), middle = (floor(tone / step_size) + 0.5) * step_size;
    float rise = tanh(sharpness * (tone - middle) / step_size) / tanh(0.5 * sharpness);
    return max(middle + 0.5 * step_size * rise, 0.0);
}

vec4 toon(vec4 image, float levels, float sharpness) {
    vec4 color = straight(finite(image));
    float light = luminance(color.rgb);
    if (light <= 0.0) return finite(image);
    // At 0.001 tanh is linear, at 80 it is a step.
    float tone = toon_tone(srgb_encode(light), finite(levels), clamp(finite(sharpness), 1e-3, 80.0));
    return finite(premultiplied(vec4(color.rgb * (srgb_decode(tone) / light), color.a)));
}
