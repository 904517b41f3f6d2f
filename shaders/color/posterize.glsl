#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

// floor(x + 0.5), since round() may round halves either way, depending on the device.
float posterize_level(float light, int space, float steps) {
    float code = space == SPACE_DISPLAY ? srgb_encode(light) : light;
    code = floor(code * steps + 0.5) / steps;
    return finite(space == SPACE_DISPLAY ? srgb_decode(code) : code);
}

vec4 posterize(vec4 image, float levels, int space, int channels, float amount) {
    vec4 color = straight(finite(image));
    float steps = max(finite(levels), 2.0) - 1.0;
    vec3 rounded;
    if (channels == CHANNELS_SEPARATE) rounded = vec3(
        posterize_level(color.r, space, steps), posterize_level(color.g, space, steps),
        posterize_level(color.b, space, steps)
    );
    else {
        float light = luminance(color.rgb);
        rounded = light > 0.0 ? color.rgb * (posterize_level(light, space, steps) / light) : vec3(0.0);
    }
    amount = finite(amount);
    color.rgb = finite(color.rgb * (1.0 - amount) + finite(rounded) * amount);
    return finite(premultiplied(color));
}
