#include "lib/curve.glsl"
#include "lib/finite.glsl"
#include "lib/oklab.glsl"
#include "lib/pi.glsl"

// The hue of HSV, 0..1 from red to red, and its saturation. Both stay the same if the color is scaled.
vec2 hue_curves_place(vec3 rgb) {
    vec3 c = max(to_rec709(rgb), 0.0);
    float most = max(c.r, max(c.g, c.b)), span = most - min(c.r, min(c.g, c.b));
    if (span <= 1e-6 * most || most <= 0.0) return vec2(0.0);
    float sixth = most == c.r ? mod((c.g - c.b) / span + 6.0, 6.0)
        : most == c.g ? (c.b - c.r) / span + 2.0 : (c.r - c.g) / span + 4.0;
    return vec2(sixth / 6.0, span / most);
}

vec4 hue_curves(
    vec4 image, const vec4 hue_by_hue[17], const vec4 saturation_by_hue[17], const vec4 light_by_hue[17],
    const vec4 saturation_by_saturation[17]
) {
    vec4 c = finite(image);
    vec2 place = hue_curves_place(c.rgb);
    float hue = place.x, saturation = place.y;
    float turn = 2.0 * PI * saturation * curve_at(hue_by_hue, hue, false);
    float factor = mix(1.0, curve_at(saturation_by_hue, hue, false), saturation);
    factor *= curve_at(saturation_by_saturation, saturation, false);
    float light = mix(1.0, curve_at(light_by_hue, hue, false), saturation);
    vec3 lab = to_oklab(c.rgb);
    lab.yz = factor * mat2(cos(turn), sin(turn), -sin(turn), cos(turn)) * lab.yz;
    return finite(vec4(light * from_oklab(lab), c.a));
}
