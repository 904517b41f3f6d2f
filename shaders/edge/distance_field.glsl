#include "lib/contour.glsl"
#include "lib/finite.glsl"

vec2 distance_field_seeds(float mask) { return contour_seeds(finite(mask), float(pixel.y)); }

vec2 distance_field_columns(int reach) { return contour_columns(seeds_at(pixel), reach); }

float distance_field() { return contour_distance(columns_at(pixel), length(vec2(extent))) / proxy; }
