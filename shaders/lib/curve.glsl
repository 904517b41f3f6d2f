// Curves and color ramps between their points, as curve_knots and ramp_knots hand them over: at most 17 points, the
// unused ones out of reach at the end.

// The height at x: cubic between points, beyond the ends level or going on as steep as there.
float curve_at(const vec4 knots[17], float x, bool extend) {
    int i = 0;
    while (i < 15 && x >= knots[i + 1].x) ++i;
    vec4 a = knots[i], b = knots[i + 1], end = x < a.x || b.x > 1.0 ? a : b;
    if (x < a.x || x >= end.x) return end.y + (extend ? end.z * (x - end.x) : 0.0);
    // Hermite's cubic: the chord, eased, and what the slopes at both ends bend it by.
    float width = b.x - a.x, t = (x - a.x) / width, s = 1.0 - t;
    return mix(a.y, b.y, t * t * (3.0 - 2.0 * t)) + width * t * s * (a.z * s - b.z * t);
}

// The color at t, level beyond the ends.
vec4 ramp_at(const vec4 knots[34], float t, bool smoothed) {
    int i = 0;
    while (i < 30 && t >= knots[i + 2].x) i += 2;
    float u = clamp((t - knots[i].x) * knots[i].y, 0.0, 1.0);
    return mix(knots[i + 1], knots[i + 3], smoothed ? u * u * (3.0 - 2.0 * u) : u);
}
