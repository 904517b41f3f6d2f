// Closed splines by name as one mask: lib/paths.glsl covers pixels.

#include "lib/paths.glsl"

float roto_matte(float matte) { return finite(matte); }

vec4 roto_fill(float mask, vec4 color) { return finite(color) * mask; }

// The mean over the times at which the shutter is open, one after the other.
float roto_expose(float total, float mask, float part) { return total + mask * part; }
