#include "lib/finite.glsl"

vec4 frame_average_first(vec4 image, float weight) { return weight * finite(image); }
vec4 frame_average_add(vec4 total, vec4 image, float weight) { return total + weight * finite(image); }
vec4 frame_average(vec4 total) { return finite(total); }
