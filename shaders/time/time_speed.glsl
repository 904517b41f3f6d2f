#include "lib/finite.glsl"

// Light is mixed, as a shutter that is open over both frames would.
vec4 time_speed_dissolve(vec4 before, vec4 after, float part) { return mix(finite(before), finite(after), part); }
