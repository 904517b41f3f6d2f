// sRGB display values, in which steps look equal from dark to bright. Light above 1 continues on the same curve.
#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

// The display value of a pixel's luminance, without its alpha.
float display_tone(vec4 c) { return srgb_encode(max(luminance(straight(finite(c)).rgb), 0.0)); }

// A premultiplied pixel with sRGB display values instead of light.
vec4 to_display(vec4 c) {
    c = straight(finite(c));
    return premultiplied(vec4(srgb_encode(c.rgb), c.a));
}

// The inverse of to_display().
vec4 from_display(vec4 c) {
    c = straight(finite(c));
    return finite(premultiplied(vec4(srgb_decode(c.rgb), c.a)));
}
