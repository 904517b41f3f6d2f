// Conversions around shaders of the Interactive Shader Format, which compute with straight display values.
#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/working.glsl"

vec4 display_straight(vec4 c) {
    c = straight(c);
    return vec4(srgb_encode(to_rec709(c.rgb)), c.a);
}

// Such shaders may leave color where alpha is 0. A display ignores it, but premultiplied light would show it.
vec4 from_straight(vec4 c) {
    float alpha = clamp(c.a, 0.0, 1.0);
    return vec4(c.rgb * alpha, alpha);
}

vec4 from_codes(vec4 c) { return from_straight(vec4(from_rec709(srgb_decode(c.rgb)), c.a)); }
