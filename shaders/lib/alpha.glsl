// Straight and premultiplied alpha. Color without coverage (a glow: alpha 0, color above 0) is valid and is kept.

const float ALPHA_NONE = 1e-6;  // division by a smaller alpha would only amplify rounding errors

// The straight color of a premultiplied pixel: its color divided by alpha.
vec4 straight(vec4 c) { return c.a > ALPHA_NONE ? vec4(c.rgb / c.a, c.a) : c; }

// The premultiplied color of a straight pixel. Color operations that are not linear work between straight() and
// premultiplied().
vec4 premultiplied(vec4 c) { return c.a > ALPHA_NONE ? vec4(c.rgb * c.a, c.a) : c; }
