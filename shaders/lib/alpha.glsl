// Straight and premultiplied alpha. Color without coverage (a glow: alpha 0, color above 0) is legal and survives.

const float ALPHA_NONE = 1e-6;  // dividing by less would only amplify rounding

// The color that a premultiplied pixel would have if it covered fully.
vec4 straight(vec4 c) { return c.a > ALPHA_NONE ? vec4(c.rgb / c.a, c.a) : c; }

// The inverse. A color operation that is not linear is applied between the two.
vec4 premultiplied(vec4 c) { return c.a > ALPHA_NONE ? vec4(c.rgb * c.a, c.a) : c; }
