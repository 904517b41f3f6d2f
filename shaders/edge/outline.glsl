#include "lib/contour.glsl"
#include "lib/finite.glsl"

float outline_alpha(vec4 image) { return finite(image.a); }

vec2 outline_seeds(float mask) { return contour_seeds(finite(mask), float(pixel.y)); }

vec2 outline_columns(int reach) { return contour_columns(seeds_at(pixel), reach); }

float outline_distance(int reach) { return contour_distance(columns_at(pixel), float(reach)); }

// The part of a pixel that lies between two distances from the contour.
float outline_line(float contour, float first, float last, float fade) {
    vec2 past = clamp((contour - vec2(first, last)) / fade + 0.5, 0.0, 1.0);
    return past.x - past.y;
}

vec4 outline(vec4 image, float line, vec4 color, bool behind) {
    vec4 safe = finite(image), ink = vec4(color.rgb * color.a, color.a) * line;
    return finite(behind ? safe + ink * (1.0 - safe.a) : ink + safe * (1.0 - ink.a));
}
