// Closed splines by name as one mask: curves become spans of 8 straight segments, which lib/paths.glsl covers.

#include "lib/paths.glsl"

ivec2 roto_curve_cell(int curve, int texel) { return ivec2(3 * (curve % PATH_BLOCK) + texel, curve / PATH_BLOCK); }

// A point of the polygon that stands for a span. Within curves it lies so far outside that the polygon has the area
// of the curve: chords lie inside by two thirds of their sagitta, which is the second derivative times dt^2 / 8.
vec4 roto_points() {
    int span = pixel.y * PATH_BLOCK + pixel.x / PATH_SEGMENTS, number = pixel.x % PATH_SEGMENTS;
    vec4 facts = spans_at(path_cell(span));
    int curve = int(facts.x);
    vec4 first = curves_at(roto_curve_cell(curve, 0)), second = curves_at(roto_curve_cell(curve, 1));
    vec4 feathers = curves_at(roto_curve_cell(curve, 2));
    float steps = max(facts.z, 1.0) * float(PATH_SEGMENTS), at = facts.y * float(PATH_SEGMENTS) + float(number);
    float t = at / steps, u = 1.0 - t;
    vec2 place = u * u * u * first.xy + 3.0 * u * u * t * first.zw + 3.0 * u * t * t * second.xy + t * t * t * second.zw;
    vec2 bend = 6.0 * (u * (first.xy - 2.0 * first.zw + second.xy) + t * (first.zw - 2.0 * second.xy + second.zw));
    if (at > 0.5) place -= bend / (12.0 * steps * steps);
    return vec4(place, mix(feathers.x, feathers.y, t), 0.0);
}

float roto_matte(float matte) { return finite(matte); }

vec4 roto_fill(float mask, vec4 color) { return finite(color) * mask; }

// The mean over the times at which the shutter is open, one after the other.
float roto_expose(float total, float mask, float part) { return total + mask * part; }

float roto_soft(float mask, float cover, vec2 nearest, int mode, float feather, float opacity, bool invert) {
    float inside = cover >= 0.5 ? nearest.x : -nearest.x;
    return path_combine(mask, path_soften(cover, inside, feather + nearest.y), mode, opacity, invert);
}
