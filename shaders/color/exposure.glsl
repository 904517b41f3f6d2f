#include "lib/finite.glsl"

vec4 exposure(vec4 image, float stops) { return finite(vec4(image.rgb * exp2(finite(stops)), image.a)); }
