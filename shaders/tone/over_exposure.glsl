#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

// A straight line up to the start, then an exponential curve with the same slope, which approaches white.
float over_exposure_shoulder(float light, float start, float white) {
    float room = white - start;
    if (light <= start) return light;
    return room > 1e-6 * white ? start + room * (1.0 - exp(-(light - start) / room)) : white;
}

vec4 over_exposure(vec4 image, float stops, float white, float shoulder, float bleach) {
    vec4 color = straight(finite(image));
    vec3 rgb = min(color.rgb * exp2(clamp(finite(stops), -64.0, 64.0)), 1e9);
    white = max(finite(white), 1e-3), bleach = max(finite(bleach), 0.0);
    float peak = largest(rgb), start = white * (1.0 - clamp(finite(shoulder), 0.0, 1.0));
    if (peak <= start) return finite(premultiplied(vec4(rgb, color.a)));
    float held = over_exposure_shoulder(peak, start, white);
    float lost = bleach * (peak - held) / white, fade = lost / (1.0 + lost);
    rgb = (1.0 - fade) * rgb * (held / peak) + fade * held;
    return finite(premultiplied(vec4(rgb, color.a)));
}
