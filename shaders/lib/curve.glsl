// Curves and color ramps, from the points that curve_knots and ramp_knots pass: at most 17. Unused points lie out of
// range at the end.

// The value of a curve at x: cubic between points. Beyond the ends it is constant, or continues with the slope of the
// end if `extend`.
float curve_at(const vec4 knots[17], float x, bool extend) {
    int i = 0;
    while (i < 15 && x >= knots[i + 1].x) ++i;
    vec4 a = knots[i], b = knots[i + 1], end = x < a.x || b.x > 1.0 ? a : b;
    if (x < a.x || x >= end.x) return end.y + (extend ? end.z * (x - end.x) : 0.0);
    // A cubic Hermite spline: a smooth step between both values, plus the slopes at both ends.
    float width = b.x - a.x, t = (x - a.x) / width, s = 1.0 - t;
    return mix(a.y, b.y, t * t * (3.0 - 2.0 * t)) + width * t * s * (a.z * s - b.z * t);
}

// The color of a ramp at t, constant beyond the ends.
vec4 ramp_at(const vec4 knots[34], float t, bool smoothed) {
    int i = 0;
    while (i < 30 && t >= knots[i + 2].x) i += 2;
    float u = clamp((t - knots[i].x) * knots[i].y, 0.0, 1.0);
    return mix(knots[i + 1], knots[i + 3], smoothed ? u * u * (3.0 - 2.0 * u) : u);
}
