#include "lib/diffusion.glsl"
#include "lib/keying.glsl"
#include "lib/morphology.glsl"

// The part of each channel in the sum of all three: color without brightness.
vec3 screen_clean_plate_hue(vec3 rgb) {
    vec3 light = max(rgb, 0.0);
    return light / max(light.r + light.g + light.b, 1e-6);
}

// 1 where the picture shows nothing but the screen.
vec4 screen_clean_plate_seen(
    vec4 image, float garbage, vec4 screen, float balance, float low, float high, float tolerance
) {
    vec3 here = finite(image.rgb), back = finite(screen.rgb);
    int channel = keying_channel(back);
    float part = keying_excess(here, channel, finite(balance)), whole = keying_excess(back, channel, finite(balance));
    bool is_lit = part >= finite(low) * whole && part <= finite(high) * whole && finite(garbage) <= 0.0;
    float away = distance(screen_clean_plate_hue(here), screen_clean_plate_hue(back));
    return vec4(is_lit && away <= finite(tolerance) ? 1.0 : 0.0);
}

float screen_clean_plate_known(vec4 seen) { return seen.r > 0.5 ? 1.0 : 0.0; }

vec4 screen_clean_plate_color(vec4 image) { return vec4(finite(image.rgb), 1.0); }

// Where nothing looks like the screen, the plate is its color.
vec4 screen_clean_plate(vec4 plate, vec4 screen, float known) {
    return vec4(known > 0.5 ? finite(plate.rgb) : finite(screen.rgb), 1.0);
}
