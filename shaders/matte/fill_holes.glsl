#include "lib/finite.glsl"

// Before a way is known, everything is filled.
float fill_holes_start() { return 1.0; }

// The limits that a pixel sets to what comes from the left or from above (xy), and from the other side (zw): not lower
// than x or z, not higher than y or w.
vec4 fill_holes_limits(float matte, float filled) {
    float low = clamp(finite(matte), 0.0, 1.0);
    return vec4(low, max(low, filled), low, max(low, filled));
}

// The limits of twice as many pixels in a row. Outside of the picture everything is 0.
vec4 fill_holes_double(int axis, int reach) {
    ivec2 away = ivec2(0);
    away[axis] = reach;
    vec4 here = limits_at(pixel), before = limits_at(pixel - away), after = limits_at(pixel + away);
    return vec4(clamp(before.xy, here.xx, here.yy), clamp(after.zw, here.zz, here.ww));
}

// What arrives from the nearer end.
float fill_holes_joined(vec4 limits) { return min(limits.x, limits.z); }
