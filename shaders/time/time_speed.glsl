#include "lib/finite.glsl"

// Mixes light, as a shutter that is open during both frames does.
vec4 time_speed_dissolve(vec4 before, vec4 after, float part) { return mix(finite(before), finite(after), part); }
