#include "lib/finite.glsl"

vec4 frame_blend_first(vec4 image) { return finite(image); }

// Both are finite, and so is what lies between them.
vec4 frame_blend(vec4 image, vec4 before, float kept) { return finite(mix(finite(image), before, kept)); }
