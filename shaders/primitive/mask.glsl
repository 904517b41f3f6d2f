// A node's mask: its result where the mask is 1, its input where it is 0.

#include "lib/finite.glsl"

// No mix(): drivers expand it in different ways, depending on what else is in the shader.

float mask_amount(float mask, float amount, bool inverted) {
    float inside = clamp(finite(mask), 0.0, 1.0);
    return clamp(finite(amount), 0.0, 1.0) * (inverted ? 1.0 - inside : inside);
}

vec4 mask_vec4(vec4 before, vec4 after, float mask, float amount, bool inverted) {
    float part = mask_amount(mask, amount, inverted);
    if (part <= 0.0) return finite(before);
    if (part >= 1.0) return finite(after);
    vec4 safe = finite(before);
    return safe + part * (finite(after) - safe);
}

float mask_float(float before, float after, float mask, float amount, bool inverted) {
    float part = mask_amount(mask, amount, inverted);
    if (part <= 0.0) return finite(before);
    if (part >= 1.0) return finite(after);
    float safe = finite(before);
    return safe + part * (finite(after) - safe);
}
