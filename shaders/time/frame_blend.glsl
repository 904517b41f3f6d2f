#include "lib/finite.glsl"

vec4 frame_blend_first(vec4 image) { return finite(image); }

// A mixture of finite colors is finite.
vec4 frame_blend(vec4 image, vec4 before, float kept) { return finite(mix(finite(image), before, kept)); }
