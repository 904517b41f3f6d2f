#include "lib/finite.glsl"

vec4 constant(vec4 color) { return finite(color); }
