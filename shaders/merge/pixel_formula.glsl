#include "lib/formula.glsl"

vec4 pixel_formula(vec4 color) { return color; }

float pixel_formula_value(vec4 color) { return color.r; }
