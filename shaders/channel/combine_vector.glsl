#include "lib/finite.glsl"

vec3 combine_vector(float x, float y, float z) { return finite(vec3(x, y, z)); }
