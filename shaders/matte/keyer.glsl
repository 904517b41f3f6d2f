#include "lib/finite.glsl"
#include "lib/keying.glsl"
#include "lib/morphology.glsl"

// How much of a pixel is not the screen. It is not clamped before black and white are applied, so that a white above 1
// sees what lies there.
float keyer_matte(vec4 image, vec4 plate, vec4 screen, float balance, float black, float white) {
    int channel = keying_channel(finite(screen.rgb));
    float part = keying_excess(finite(image.rgb), channel, finite(balance));
    float whole = keying_excess(finite(plate.rgb), channel, finite(balance));
    float matte = finite(1.0 - part / max(whole, 1e-6));
    return clamp(finite((matte - finite(black)) / max(finite(white) - finite(black), 1e-6)), 0.0, 1.0);
}

vec4 keyer_wide(float matte) { return vec4(matte); }

float keyer_narrow(vec4 wide) { return wide.r; }

float keyer_join(float core, float garbage, float cover) {
    float solid = max(cover, clamp(finite(core), 0.0, 1.0));
    return solid * (1.0 - clamp(finite(garbage), 0.0, 1.0));
}

float keyer_coverage(vec4 image, float cover) { return cover * clamp(finite(image.a), 0.0, 1.0); }

// Subtracts the screen, then the light that the screen throws on the subject.
vec4 keyer(vec4 image, float cover, vec4 plate, vec4 screen, float spill, float spill_balance) {
    vec4 c = finite(image);
    int channel = keying_channel(finite(screen.rgb));
    vec3 subject = c.rgb - (1.0 - cover) * finite(plate.rgb);
    subject[channel] -= finite(spill) * max(keying_excess(subject, channel, finite(spill_balance)), 0.0);
    return vec4(cover > 0.0 ? finite(max(subject, min(c.rgb, 0.0))) : vec3(0.0), cover * c.a);
}
