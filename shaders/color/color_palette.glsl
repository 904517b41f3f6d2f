#include "lib/alpha.glsl"
#include "lib/bayer.glsl"
#include "lib/blue_noise.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

float color_palette_threshold(int dither, ivec2 cell) {
    if (dither == DITHER_NONE) return 0.5;
    if (dither == DITHER_BLUE_NOISE) return blue_noise(cell);
    return bayer(cell, dither == DITHER_BAYER_2 ? 1 : dither == DITHER_BAYER_4 ? 2 : 3);
}

// What a pattern adds to a pixel.
float color_palette_shift(int dither, float spread, float size) {
    ivec2 cell = ivec2((vec2(pixel) + 0.5) / max(finite(size), 1.0));
    return finite(spread) * (color_palette_threshold(dither, cell) - 0.5);
}

// What the program on the processor takes: sRGB codes without alpha, with a pattern or without it.
vec4 color_palette_codes(vec4 image) {
    vec4 c = straight(finite(image));
    return vec4(srgb_encode(max(c.rgb, 0.0)), c.a);
}

vec4 color_palette_pattern(vec4 codes, int dither, float spread, float size) {
    return vec4(codes.rgb + color_palette_shift(dither, spread, size), codes.a);
}

vec4 color_palette_join(vec4 image, vec4 reduced) {
    return premultiplied(vec4(finite(reduced).rgb, straight(finite(image)).a));
}

vec4 color_palette(vec4 image, const vec4 colors[34], int count, int dither, float spread, float size) {
    vec4 c = straight(finite(image));
    vec3 code = srgb_encode(max(c.rgb, 0.0)) + color_palette_shift(dither, spread, size);
    vec3 nearest = vec3(0.0);
    float least = 3e38;
    for (int i = 0; i < min(count, 17); ++i) {
        vec3 color = finite(colors[2 * i + 1].rgb), away = srgb_encode(max(color, 0.0)) - code;
        float apart = dot(away, away);
        if (apart >= least) continue;
        least = apart;
        nearest = color;
    }
    return premultiplied(vec4(nearest, c.a));
}
