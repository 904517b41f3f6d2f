#include "lib/finite.glsl"

vec4 combine(float red, float green, float blue, float alpha) { return finite(vec4(red, green, blue, alpha)); }
