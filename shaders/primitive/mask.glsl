// A node's mask: its result where the mask is 1, its input where it is 0.

#include "lib/finite.glsl"

float mask_amount(float mask, float amount, bool inverted) {
    float inside = clamp(finite(mask), 0.0, 1.0);
    return clamp(finite(amount), 0.0, 1.0) * (inverted ? 1.0 - inside : inside);
}

vec4 mask_vec4(vec4 before, vec4 after, float mask, float amount, bool inverted) {
    float part = mask_amount(mask, amount, inverted);
    if (part <= 0.0) return finite(before);
    return part >= 1.0 ? finite(after) : mix(finite(before), finite(after), part);
}

float mask_float(float before, float after, float mask, float amount, bool inverted) {
    float part = mask_amount(mask, amount, inverted);
    if (part <= 0.0) return finite(before);
    return part >= 1.0 ? finite(after) : mix(finite(before), finite(after), part);
}
