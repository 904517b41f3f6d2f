#include "lib/finite.glsl"

vec2 combine_vector2(float x, float y) { return finite(vec2(x, y)); }
