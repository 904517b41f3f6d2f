#include "lib/color.glsl"
#include "lib/finite.glsl"

// How much the screen's channel exceeds the limit that the other two channels set.
float chroma_key_excess(vec3 rgb, int channel, int limit) {
    float next = rgb[(channel + 1) % 3], after = rgb[(channel + 2) % 3];
    return rgb[channel] - (limit == LIMIT_AVERAGE ? 0.5 * (next + after) : max(next, after));
}

// The part of each channel in the sum of all three: color without brightness.
vec3 chroma_key_chromaticity(vec3 rgb) {
    vec3 light = max(rgb, 0.0);
    return light / max(light.r + light.g + light.b, 1e-6);
}

void chroma_key(
    vec4 image, vec4 screen, int method, int limit, float black, float white, float tolerance, float spill,
    out vec4 result, out float matte
) {
    image = finite(image);
    vec3 back = finite(screen.rgb);
    int channel = back.g >= back.r && back.g >= back.b ? 1 : back.b >= back.r ? 2 : 0;
    float empty;  // the part of the pixel that shows the screen
    if (method == METHOD_DISTANCE) {
        float away = distance(chroma_key_chromaticity(image.rgb), chroma_key_chromaticity(back));
        empty = 1.0 - away / max(finite(tolerance), 1e-6);
    } else {
        float excess = chroma_key_excess(back, channel, limit);
        empty = chroma_key_excess(image.rgb, channel, limit) / max(excess, 1e-6);
    }
    float cover = (1.0 - clamp(finite(empty), 0.0, 1.0) - finite(black)) / max(finite(white) - finite(black), 1e-6);
    cover = clamp(finite(cover), 0.0, 1.0);
    // Subtract the screen, then the light that the screen throws on the subject (spill).
    vec3 subject = image.rgb - (1.0 - cover) * back;
    subject[channel] -= finite(spill) * max(chroma_key_excess(subject, channel, limit), 0.0);
    result = finite(vec4(cover > 0.0 ? max(subject, min(image.rgb, 0.0)) : vec3(0.0), cover * image.a));
    matte = cover * clamp(image.a, 0.0, 1.0);
}
