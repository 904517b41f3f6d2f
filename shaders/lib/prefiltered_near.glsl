// A picture that was made smaller in steps, in a pass that reads `levels`: see lib/prefiltered.glsl.

#include "lib/prefiltered.glsl"

// The mean of the picture around a place, over a square `width` pixels wide, from its `levels`; of size `size`.
vec4 prefiltered_near(vec2 place, float width, ivec2 size) {
    int level = int(clamp(log2(max(width, 1.0)) + 0.5, 0.0, float(PREFILTERED_LEVELS)));
    vec2 cells = vec2(prefiltered_cells(size, level)), at = clamp(place / float(1 << level), vec2(0.5), cells - 0.5);
    return levels_near(vec2(prefiltered_corner(size, level)) + at);
}
