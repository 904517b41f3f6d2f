// Blend modes of one channel (W3C Compositing and Blending 1): b is the background, a the foreground, both straight and
// not negative. The W3C defines them for 0..1; here they continue for brighter light without a jump.

// Screen is not defined above 1: there the brighter one wins, as in Nuke.
float blend_screen(float b, float a) { return max(a, b) > 1.0 ? max(a, b) : a + b - a * b; }

// Dark light of a multiplies b, bright light screens it: twice a, or what is over 1 of it.
float blend_hard_light(float b, float a) { return a <= 0.5 ? 2.0 * a * b : blend_screen(b, 2.0 * a - 1.0); }

// A background of 1 or more stays; the foreground counts up to 1.
float blend_soft_light(float b, float a) {
    a = min(a, 1.0);
    if (b >= 1.0) return b;
    if (a <= 0.5) return b - (1.0 - 2.0 * a) * b * (1.0 - b);
    float lighter = b <= 0.25 ? ((16.0 * b - 12.0) * b + 4.0) * b : sqrt(b);
    return b + (2.0 * a - 1.0) * (lighter - b);
}

// Limited to 1, or to the background if that is brighter.
float blend_color_dodge(float b, float a) {
    if (b == 0.0) return 0.0;
    return a >= 1.0 ? max(b, 1.0) : min(max(b, 1.0), b / (1.0 - a));
}

// A background of 1 or more stays.
float blend_color_burn(float b, float a) {
    if (b >= 1.0) return b;
    return a <= 0.0 ? 0.0 : 1.0 - min(1.0, (1.0 - b) / a);
}
