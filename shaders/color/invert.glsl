#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

const float invert_gray = 0.18;  // middle gray: the value that inverting in stops leaves as it is
const float invert_range = 256.0;  // eight stops: values are clamped to so many times middle gray, up and down

vec3 invert_stops(vec3 rgb) {
    return invert_gray * invert_gray / clamp(rgb, vec3(invert_gray / invert_range), vec3(invert_gray * invert_range));
}

vec4 invert(vec4 image, int space, float amount) {
    vec4 color = straight(finite(image)), negative = color;
    if (space == SPACE_DISPLAY) negative.rgb = srgb_decode(1.0 - srgb_encode(color.rgb));
    if (space == SPACE_LINEAR) negative.rgb = 1.0 - color.rgb;
    if (space == SPACE_STOPS) negative.rgb = invert_stops(color.rgb);
    // Two products, since mix() may compute x + (y - x) * a: with an amount of 1 its rounding would depend on the
    // picture.
    amount = color.a > ALPHA_NONE ? finite(amount) : 0.0;  // a transparent pixel has no negative
    color.rgb = finite(color.rgb * (1.0 - amount) + finite(negative.rgb) * amount);
    return finite(premultiplied(color));
}
