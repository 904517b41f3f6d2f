#include "lib/alpha.glsl"
#include "lib/finite.glsl"

vec4 unpremultiply(vec4 image) { return finite(straight(finite(image))); }
