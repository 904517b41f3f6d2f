#include "lib/color.glsl"
#include "lib/finite.glsl"

vec4 sharpen(vec4 image, vec4 soft, float amount, float threshold, float limit, int channels) {
    image = finite(image);
    bool gray = channels == CHANNELS_LUMINANCE;
    vec3 sharp = gray ? vec3(luminance(image.rgb)) : image.rgb;
    vec3 detail = sharp - (gray ? vec3(luminance(soft.rgb)) : soft.rgb);
    detail = sign(detail) * clamp(abs(detail) - threshold, vec3(0.0), limit * abs(sharp));
    return finite(vec4(image.rgb + amount * detail, image.a));
}
