#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

const float invert_gray = 0.18;  // what `stops` leaves as it is
const float invert_range = 256.0;  // eight stops

vec3 invert_stops(vec3 rgb) {
    return invert_gray * invert_gray / clamp(rgb, vec3(invert_gray / invert_range), vec3(invert_gray * invert_range));
}

vec4 invert(vec4 image, int space, float amount) {
    vec4 color = straight(finite(image)), negative = color;
    if (space == SPACE_DISPLAY) negative.rgb = srgb_decode(1.0 - srgb_encode(color.rgb));
    if (space == SPACE_LINEAR) negative.rgb = 1.0 - color.rgb;
    if (space == SPACE_STOPS) negative.rgb = invert_stops(color.rgb);
    // Two products, not mix(): the whole negative must not depend on how bright the picture was.
    amount = color.a > ALPHA_NONE ? finite(amount) : 0.0;  // what covers nothing has no negative
    color.rgb = finite(color.rgb * (1.0 - amount) + finite(negative.rgb) * amount);
    return finite(premultiplied(color));
}
