// What formulas for pixels call. Every number is a vec4; what has no value is 0, as in the node math.
#include "lib/finite.glsl"

// A picture or a number that a formula reads.
vec4 formula_read(vec4 c) { return finite(c); }

// A picture or a number that a formula reads.
vec4 formula_read(float x) { return vec4(finite(x)); }

// The result as four channels: a number is an opaque gray, and a list of three an opaque color.
vec4 formula_end(vec4 part, int channels) {
    vec4 c = finite(part);
    return channels == 1 ? vec4(c.xxx, 1.0) : channels == 2 ? vec4(c.xy, 0.0, 1.0)
        : channels == 3 ? vec4(c.xyz, 1.0) : c;
}

// The numbers of `c` where a function has a value, else 0.
vec4 formula_where(bvec4 valid, vec4 c) { return mix(vec4(0.0), c, valid); }

// a / b.
vec4 formula_divide(vec4 a, vec4 b) {
    bvec4 valid = notEqual(b, vec4(0.0));
    return formula_where(valid, a / mix(vec4(1.0), b, valid));
}

// The remainder of a / b, with the sign of b.
vec4 formula_mod(vec4 a, vec4 b) {
    bvec4 valid = notEqual(b, vec4(0.0));
    vec4 divisor = mix(vec4(1.0), b, valid);
    return formula_where(valid, a - divisor * floor(a / divisor));
}

// Powers of negative numbers have a value for whole exponents.
float formula_power(float x, float y) {
    if (y == 0.0) return 1.0;
    if (x == 0.0) return 0.0;
    if (x < 0.0 && y != floor(y)) return 0.0;
    float power = pow(abs(x), y);
    return x < 0.0 && mod(abs(y), 2.0) == 1.0 ? -power : power;
}

// a to the power of b.
vec4 formula_pow(vec4 a, vec4 b) {
    return vec4(
        formula_power(a.x, b.x), formula_power(a.y, b.y), formula_power(a.z, b.z), formula_power(a.w, b.w)
    );
}

// The sine of an angle in radians.
vec4 formula_sin(vec4 x) { return sin(x); }

// The cosine of an angle in radians.
vec4 formula_cos(vec4 x) { return cos(x); }

// The tangent of an angle in radians.
vec4 formula_tan(vec4 x) { return tan(x); }

// By the arc tangent: drivers approximate asin() and acos() to three digits only.
vec4 formula_asin(vec4 x) {
    return formula_where(lessThanEqual(abs(x), vec4(1.0)), atan(x, sqrt(max(1.0 - x * x, 0.0))));
}

// The angle in radians with that cosine.
vec4 formula_acos(vec4 x) {
    return formula_where(lessThanEqual(abs(x), vec4(1.0)), atan(sqrt(max(1.0 - x * x, 0.0)), x));
}

// The angle in radians with that tangent.
vec4 formula_atan(vec4 x) { return atan(x); }

// The angle in radians from the x axis to the point x, y.
vec4 formula_atan2(vec4 y, vec4 x) {
    bvec4 valid = notEqual(abs(x) + abs(y), vec4(0.0));
    return formula_where(valid, atan(y, mix(vec4(1.0), x, valid)));
}

// Radians as degrees.
vec4 formula_degrees(vec4 x) { return degrees(x); }

// Degrees as radians.
vec4 formula_radians(vec4 x) { return radians(x); }

// The square root.
vec4 formula_sqrt(vec4 x) { return sqrt(max(x, 0.0)); }

// e to the power of x.
vec4 formula_exp(vec4 x) { return exp(x); }

// The natural logarithm.
vec4 formula_log(vec4 x) { return formula_where(greaterThan(x, vec4(0.0)), log(max(x, 1e-38))); }

// The logarithm to base 2.
vec4 formula_log2(vec4 x) { return formula_where(greaterThan(x, vec4(0.0)), log2(max(x, 1e-38))); }

// x without its sign.
vec4 formula_abs(vec4 x) { return abs(x); }

// -1, 0 or 1.
vec4 formula_sign(vec4 x) { return sign(x); }

// The whole number at or below x.
vec4 formula_floor(vec4 x) { return floor(x); }

// The whole number at or above x.
vec4 formula_ceil(vec4 x) { return ceil(x); }

// The nearest whole number, halves away from zero.
vec4 formula_round(vec4 x) { return sign(x) * floor(abs(x) + 0.5); }

// x without its whole part.
vec4 formula_fract(vec4 x) { return x - floor(x); }

// x within low and high.
vec4 formula_clamp(vec4 x, vec4 low, vec4 high) { return min(max(x, low), high); }

// From a at t = 0 to b at t = 1.
vec4 formula_mix(vec4 a, vec4 b, vec4 t) { return a * (1.0 - t) + b * t; }

// 0 below the edge, else 1.
vec4 formula_step(vec4 edge, vec4 x) { return step(edge, x); }

// Where x lies between low and high: from 0 to 1.
vec4 formula_part(vec4 low, vec4 high, vec4 x) {
    bvec4 wide = notEqual(low, high);
    return mix(step(low, x), clamp((x - low) / mix(vec4(1.0), high - low, wide), 0.0, 1.0), wide);
}

// 0 below low, 1 above high, smooth between.
vec4 formula_smoothstep(vec4 low, vec4 high, vec4 x) {
    vec4 t = formula_part(low, high, x);
    return t * t * (3.0 - 2.0 * t);
}

// From a where x is low to b where it is high, level outside.
vec4 formula_fit(vec4 x, vec4 low, vec4 high, vec4 a, vec4 b) { return formula_mix(a, b, formula_part(low, high, x)); }

// 1 from start until before end, else 0.
vec4 formula_pulse(vec4 x, vec4 start, vec4 end) {
    return vec4(greaterThanEqual(x, start)) * vec4(lessThan(x, end));
}
