#include "lib/finite.glsl"

float edge_matte(float matte, float soft, int side, float gain) {
    float m = clamp(finite(matte), 0.0, 1.0), s = clamp(finite(soft), 0.0, 1.0);
    float part = side == SIDE_INSIDE ? m : side == SIDE_OUTSIDE ? 1.0 - m : 1.0;
    return min(4.0 * s * (1.0 - s) * part * finite(gain), 1.0);
}
