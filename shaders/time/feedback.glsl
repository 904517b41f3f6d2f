#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/resampling.glsl"

const float feedback_widest = 8.0;  // pixels of the past per pixel; stronger shrinking may alias

// The light that is fed back: finite, between 0 and the ceiling.
vec4 feedback_first(vec4 image, float ceiling) {
    vec4 safe = finite(image);
    return vec4(clamp(safe.rgb, 0.0, ceiling), clamp(safe.a, 0.0, 1.0));
}

// The transformed past, by Catmull-Rom interpolation, wider where the picture shrinks, and limited to the four pixels
// around.
vec4 feedback_past(vec2 across, vec2 down, vec2 start, float hue_turn, float decay) {
    vec2 at = vec2(pixel) + 0.5;
    vec2 center = vec2(dot(across, at), dot(down, at)) + start;
    center = clamp(center, -1e6, 1e6);
    float width = clamp(length(across), 1.0, feedback_widest);
    ivec2 from = ivec2(floor(center - 2.0 * width)), to = ivec2(ceil(center + 2.0 * width));
    ivec2 corner = ivec2(floor(center - 0.5));
    vec4 sum = vec4(0.0), low = vec4(1e9), high = vec4(-1e9);
    float total = 0.0;
    for (int y = from.y; y < to.y; ++y) {
        float row = cubic_weight((float(y) + 0.5 - center.y) / width, 0.0, 0.5);
        for (int x = from.x; x < to.x; ++x) {
            float weight = row * cubic_weight((float(x) + 0.5 - center.x) / width, 0.0, 0.5);
            vec4 light = history_at(ivec2(x, y));
            sum += weight * light;
            total += weight;
            ivec2 away = ivec2(x, y) - corner;
            if (all(greaterThanEqual(away, ivec2(0))) && all(lessThanEqual(away, ivec2(1)))) {
                low = min(low, light), high = max(high, light);
            }
        }
    }
    vec4 past = decay * clamp(sum / total, low, high);
    return hue_turn == 0.0 ? past : vec4(with_hue(past.rgb, hue(past.rgb) + hue_turn), past.a);
}

// Screen is not defined above 1: there the brighter one wins, as in `merge`.
vec3 feedback_screen(vec3 a, vec3 b) {
    return mix(a + b - a * b, max(a, b), greaterThan(max(a, b), vec3(1.0)));
}

vec4 feedback(vec4 image, vec4 past, int mode, float decay) {
    vec4 safe = finite(image);
    float both = safe.a + past.a * (1.0 - safe.a);
    if (mode == MODE_BRIGHTEST) return max(safe, past);
    if (mode == MODE_ADD) return finite(vec4(safe.rgb + past.rgb, min(safe.a + past.a, 1.0)));
    if (mode == MODE_SCREEN) return vec4(feedback_screen(max(safe.rgb, 0.0), past.rgb), both);
    if (mode == MODE_OVER) return finite(safe + (1.0 - safe.a) * past);
    return (1.0 - decay) * safe + past;  // the mode mix; the past has faded already
}
