#include "lib/finite.glsl"

vec4 combine_vector4(float x, float y, float z, float w) { return finite(vec4(x, y, z, w)); }
