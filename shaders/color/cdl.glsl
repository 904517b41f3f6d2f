#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

float cdl_power(float light, float power) { return light > 0.0 ? pow(light, max(power, 0.0)) : light; }

vec4 cdl(vec4 image, int style, vec4 slope, vec4 offset, vec4 power, float saturation) {
    image = finite(image), slope = finite(slope), offset = finite(offset), power = finite(power);
    // Slope and offset work on premultiplied color, so that transparent pixels stay black.
    vec4 color = straight(vec4(image.rgb * slope.rgb + image.a * offset.rgb, image.a));
    bool limited = style == STYLE_ASC;
    if (limited) color.rgb = clamp(color.rgb, 0.0, 1.0);
    color.rgb = vec3(cdl_power(color.r, power.r), cdl_power(color.g, power.g), cdl_power(color.b, power.b));
    color.rgb = finite(color.rgb);
    color.rgb = finite(mix(vec3(luminance(color.rgb)), color.rgb, finite(saturation)));
    if (limited) color.rgb = clamp(color.rgb, 0.0, 1.0);
    return finite(premultiplied(color));
}
