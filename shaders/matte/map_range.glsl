#include "lib/finite.glsl"

float map_range(
    float field, float from_low, float from_high, float to_low, float to_high, int kind, float steps, bool limit
) {
    float low = finite(from_low), length = finite(from_high) - low, away = finite(field) - low;
    float t = length == 0.0 ? (away < 0.0 ? 0.0 : 1.0) : away / length;
    if (limit || kind == KIND_SMOOTH || kind == KIND_SMOOTHER) t = clamp(t, 0.0, 1.0);
    if (kind == KIND_SMOOTH) t = t * t * (3.0 - 2.0 * t);
    if (kind == KIND_SMOOTHER) t = t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
    if (kind == KIND_STEPS) {
        float count = max(floor(finite(steps) + 0.5), 2.0);
        float step_number = floor(t * count);
        if (limit) step_number = clamp(step_number, 0.0, count - 1.0);
        t = step_number / (count - 1.0);
    }
    float mapped = mix(finite(to_low), finite(to_high), t);
    return finite(mapped);
}
