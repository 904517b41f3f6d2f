#include "lib/finite.glsl"

// What the channel of the screen has above the limit that the other two, `first` and `second`, set.
float despill_excess(float own, float first, float second, int limit, float scale) {
    float most = 0.5 * (first + second);
    if (limit == LIMIT_MAXIMUM) most = max(first, second);
    if (limit == LIMIT_MINIMUM) most = min(first, second);
    if (limit == LIMIT_DOUBLE) most = (2.0 * first + second) / 3.0;
    return max(own - scale * most, 0.0);
}

// Every step is linear in the color, so that premultiplied color needs no division.
vec4 despill(vec4 image, int screen, int limit, float amount, float scale, float keep_light) {
    vec4 c = finite(image);
    int at = screen == SCREEN_RED ? 0 : screen == SCREEN_GREEN ? 1 : 2;
    float first = at == 0 ? c.g : c.r, second = at == 2 ? c.g : c.b;
    float excess = finite(amount) * despill_excess(c[at], first, second, limit, finite(scale));
    c[at] -= excess;
    vec3 weights = vec3(0.2126, 0.7152, 0.0722);  // Rec. 709
    c.rgb += finite(keep_light) * excess * weights[at];
    return c;
}
