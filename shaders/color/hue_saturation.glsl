#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/oklab.glsl"
#include "lib/pi.glsl"

vec3 hue_saturation_perceptual(vec3 rgb, float turn, float saturation) {
    vec3 lab = to_oklab(rgb);
    mat2 wheel = mat2(cos(turn), sin(turn), -sin(turn), cos(turn));
    return from_oklab(vec3(lab.x, wheel * lab.yz * saturation));
}

// Rotates the color around the gray axis (Rodrigues' formula), then adds gray so that the luminance stays.
vec3 hue_saturation_luminance(vec3 rgb, float turn, float saturation) {
    const vec3 gray = vec3(0.57735027);
    vec3 turned = rgb * cos(turn) + cross(gray, rgb) * sin(turn) + gray * dot(gray, rgb) * (1.0 - cos(turn));
    turned += luminance(rgb) - luminance(turned);
    return mix(vec3(luminance(rgb)), turned, saturation);
}

// Saturation is limited to the value at which the smallest channel becomes 0.
vec3 hue_saturation_hsv(vec3 rgb, float turn, float saturation) {
    float high = largest(rgb), spread = high - smallest(rgb);
    float strongest = spread > 0.0 ? max(high / spread, 1.0) : 1.0;
    return mix(vec3(high), with_hue(rgb, hue(rgb) + turn / (2.0 * PI)), min(saturation, strongest));
}

vec4 hue_saturation(vec4 image, int mode, float hue, float saturation, float value) {
    image = finite(image), hue = finite(hue), saturation = finite(saturation);
    vec3 rgb = image.rgb;
    if (mode == MODE_PERCEPTUAL) rgb = hue_saturation_perceptual(image.rgb, hue, saturation);
    if (mode == MODE_LUMINANCE) rgb = hue_saturation_luminance(image.rgb, hue, saturation);
    if (mode == MODE_HSV) rgb = hue_saturation_hsv(image.rgb, hue, saturation);
    return finite(vec4(finite(rgb) * finite(value), image.a));
}
