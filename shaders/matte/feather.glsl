#include "lib/finite.glsl"

// One half of a soft edge, which is 0.5 where the hard edge was.
vec4 feather(vec4 image, vec4 soft, int side) {
    vec4 hard = finite(image), s = finite(soft);
    return side == SIDE_INSIDE ? min(hard, max(2.0 * s - 1.0, 0.0)) : max(hard, min(2.0 * s, 1.0));
}
