#include "lib/finite.glsl"

// The mean of the finite values of a channel in the 3 x 3 pixels around.
float sanitize_around(int channel) {
    float sum = 0.0, count = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            if (!inside(pixel + ivec2(x, y), image_size)) continue;
            float value = image_raw(pixel + ivec2(x, y))[channel];
            if (is_finite(value)) sum += clamp(value, -1e37, 1e37), count += 1.0;
        }
    return count > 0.0 ? sum / count : 0.0;
}

vec4 sanitize(int repair, int negative, float maximum, bool limit_alpha) {
    vec4 color = image_raw(pixel);
    for (int channel = 0; channel < 4; ++channel)
        if (!is_finite(color[channel])) color[channel] = repair == REPAIR_BLACK ? 0.0 : sanitize_around(channel);
    if (negative == NEGATIVE_CLIP) color.rgb = max(color.rgb, 0.0);
    if (negative == NEGATIVE_MIRROR) color.rgb = abs(color.rgb);
    return vec4(clamp(color.rgb, -maximum, maximum), clamp(color.a, 0.0, limit_alpha ? 1.0 : maximum));
}
