#include "lib/acescct.glsl"
#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/curve.glsl"
#include "lib/finite.glsl"

float curves_encode(float light, int space) {
    return space == SPACE_DISPLAY ? srgb_encode(light) : space == SPACE_LOG ? acescct_encode(light) : light;
}

float curves_decode(float code, int space) {
    return space == SPACE_DISPLAY ? srgb_decode(code) : space == SPACE_LOG ? acescct_decode(min(code, 2.0)) : code;
}

vec3 curves_bent(
    vec3 rgb, int space, bool keep_color,
    const vec4 master[17], const vec4 red[17], const vec4 green[17], const vec4 blue[17]
) {
    if (keep_color) {
        float light = luminance(rgb), bent = curves_decode(curve_at(master, curves_encode(light, space), true), space);
        rgb = light > 1e-6 ? rgb * (bent / light) : rgb + (bent - light);
    }
    vec3 code = vec3(curves_encode(rgb.r, space), curves_encode(rgb.g, space), curves_encode(rgb.b, space));
    // In a loop, drivers compile the curve once for all channels.
    for (int channel = 0; channel < (keep_color ? 0 : 3); ++channel)
        code[channel] = curve_at(master, code[channel], true);
    code = vec3(curve_at(red, code.r, true), curve_at(green, code.g, true), curve_at(blue, code.b, true));
    return vec3(curves_decode(code.r, space), curves_decode(code.g, space), curves_decode(code.b, space));
}

vec4 curves(
    vec4 image, int space, bool keep_color,
    const vec4 master[17], const vec4 red[17], const vec4 green[17], const vec4 blue[17]
) {
    vec4 color = straight(finite(image));
    // Transparent pixels stay black: what the curves make of black is taken away.
    vec3 bent = vec3(0.0), from = color.rgb;
    for (int turn = 0; turn < (color.a <= ALPHA_NONE ? 2 : 1); ++turn) {
        vec3 curved = curves_bent(from, space, keep_color, master, red, green, blue);
        bent = turn == 0 ? curved : bent - curved;
        from = vec3(0.0);
    }
    color.rgb = finite(bent);
    return finite(premultiplied(color));
}
