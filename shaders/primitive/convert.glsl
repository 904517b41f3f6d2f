// Conversions between types: the parameter's type converts, the function has nothing to compute.

float as_float(float value) { return value; }
vec2 as_vec2(vec2 value) { return value; }
vec3 as_vec3(vec3 value) { return value; }
vec4 as_vec4(vec4 value) { return value; }
