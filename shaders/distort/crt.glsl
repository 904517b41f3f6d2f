#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/hash.glsl"
#include "lib/pi.glsl"

// The mean of a cosine over `width` turns around a phase, both in turns. Periods shorter than two pixels would cause
// moire, so they fade out before: the fade starts at 0.45 turns for a pixel.
float crt_cosine(float phase, float width) {
    if (width >= 0.5) return 0.0;
    float half_turn = PI * width, fade = min(10.0 - 20.0 * width, 1.0);
    return fade * cos(2.0 * PI * phase) * (half_turn > 1e-4 ? sin(half_turn) / half_turn : 1.0);
}

vec4 crt(
    float barrel, float jitter, float chroma_delay, float lines, float scanlines, int mask, float mask_strength,
    float triad
) {
    vec2 at = vec2(pixel) + 0.5, center = 0.5 * vec2(extent);
    vec2 away = (at - center) / center.y;
    vec2 source = center + center.y * away * (1.0 + barrel * dot(away, away));
    float line = source.y / float(extent.y) * lines;
    source.x += jitter * (2.0 * hash3(ivec3(int(floor(line)), frame, 0), uvec3(0u)).x - 1.0);
    vec4 light = image_near(source), late = image_near(source - vec2(chroma_delay, 0.0));
    vec3 rgb = luminance(light.rgb) + late.rgb - luminance(late.rgb);
    // Scan lines are brightest in their middle. The division keeps the mean brightness.
    rgb *= (1.0 - 0.5 * scanlines * (1.0 + crt_cosine(line, lines / float(extent.y)))) / (1.0 - 0.5 * scanlines);
    if (mask != MASK_NONE) {
        float stripe = at.x / triad;
        if (mask == MASK_SHADOW_MASK) stripe += 0.5 * mod(floor(at.y / triad), 2.0);
        for (int channel = 0; channel < 3; ++channel)
            rgb[channel] *= 1.0 + mask_strength * crt_cosine(stripe - (float(channel) + 0.5) / 3.0, 1.0 / triad);
    }
    return finite(vec4(rgb, light.a));
}
