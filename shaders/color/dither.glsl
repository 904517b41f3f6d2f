#include "lib/alpha.glsl"
#include "lib/bayer.glsl"
#include "lib/blue_noise.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/hash.glsl"

// The offset of the pattern for a channel or frame: steps of the R2 sequence (Roberts 2018) in 64ths, so that each
// offset is far from those before.
ivec2 dither_start(int number) { return ivec2(number) * ivec2(48, 36); }

float dither_threshold(int pattern, ivec2 cell, int channel) {
    if (pattern == PATTERN_WHITE) return hash3(ivec3(cell, channel), uvec3(0u)).x;
    cell += dither_start(channel);
    return pattern == PATTERN_BAYER ? bayer(cell, 3) : blue_noise(cell);
}

float dither_level(float light, int space, float steps, float threshold) {
    float code = (space == SPACE_DISPLAY ? srgb_encode(light) : light) * steps;
    // A code that is a whole number up to rounding errors is at a level already: it must not be moved to the next one.
    if (abs(code - round(code)) < 1e-3) code = round(code);
    code = ceil(code - threshold) / steps;
    return finite(space == SPACE_DISPLAY ? srgb_decode(code) : code);
}

vec4 dither(vec4 image, int pattern, float levels, int space, float size, bool colored, bool animate) {
    vec4 color = straight(finite(image));
    float steps = max(finite(levels), 2.0) - 1.0;
    ivec2 cell = ivec2((vec2(pixel) + 0.5) / max(finite(size), 1.0)) + (animate ? dither_start(3 * frame) : ivec2(0));
    for (int channel = 0; channel < 3; ++channel) {
        float threshold = dither_threshold(pattern, cell, colored ? channel : 0);
        color[channel] = dither_level(color[channel], space, steps, threshold);
    }
    return finite(premultiplied(color));
}
