#include "lib/finite.glsl"

vec4 mix_images(vec4 a, vec4 b, float factor) { return finite(mix(finite(a), finite(b), finite(factor))); }
