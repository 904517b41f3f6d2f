#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/agx.glsl"

// Display luminance for scene luminance, both above 0.
float tone_map_luminance(int operator, float light, float key, float average, float maximum, float bias) {
    float keyed = light * key / average, white = maximum * key / average;
    if (operator == OPERATOR_REINHARD) return keyed / (1.0 + keyed);
    if (operator == OPERATOR_REINHARD_EXTENDED) return keyed * (1.0 + keyed / (white * white)) / (1.0 + keyed);
    if (operator == OPERATOR_LOGARITHMIC) return log(1.0 + light) / log(1.0 + maximum);
    // Drago: the base of the logarithm goes from 2 for shadows to 10 for the maximum, on a display of 100 cd/m2.
    float power = log(bias) / log(0.5);
    float base = 2.0 + 8.0 * pow(light / maximum, power);
    return log(light / average + 1.0) / log(base) / (log(maximum / average + 1.0) / log(10.0));
}

// ACES RRT and sRGB ODT (Hill). Rows, multiplied from the left.
vec3 tone_map_aces(vec3 rgb) {
    vec3 v = rgb * mat3(0.59719, 0.35458, 0.04823, 0.07600, 0.90834, 0.01566, 0.02840, 0.13383, 0.83777);
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return v * mat3(1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327, -0.07276, 1.07602);
}

// Takes off the reflection of clear coat (Fresnel, 4 %), compresses above 0.8 and fades the brightest to white.
vec3 tone_map_neutral(vec3 rgb) {
    const float start = 0.8 - 0.04, desaturation = 0.15, range = 1.0 - start;
    float x = smallest(rgb);
    rgb -= x < 0.08 ? x - 6.25 * x * x : 0.04;
    float peak = largest(rgb);
    if (peak < start) return rgb;
    float compressed = 1.0 - range * range / (peak + range - start);
    float fade = 1.0 - 1.0 / (desaturation * (peak - compressed) + 1.0);
    return mix(rgb * compressed / peak, vec3(compressed), fade);
}

vec3 tone_map_hable(vec3 x) {
    return (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 0.02 / 0.3;
}

vec4 tone_map(
    vec4 image, int operator, float exposure, float key, float average, float maximum, float bias, float saturation,
    bool clip
) {
    vec4 color = straight(finite(image));
    vec3 rgb = min(max(color.rgb, 0.0) * exp2(clamp(finite(exposure), -64.0, 64.0)), 1e9);
    if (operator == OPERATOR_ACES) rgb = tone_map_aces(rgb);
    else if (operator == OPERATOR_AGX) rgb = agx(rgb);
    else if (operator == OPERATOR_KHRONOS_NEUTRAL) rgb = tone_map_neutral(rgb);
    else if (operator == OPERATOR_HABLE) rgb = tone_map_hable(2.0 * rgb) / tone_map_hable(vec3(11.2));
    else {
        float light = max(luminance(rgb), 1e-12);
        average = max(finite(average), 1e-9), maximum = max(finite(maximum), 1e-9);
        float shown = tone_map_luminance(operator, light, finite(key), average, maximum, clamp(bias, 0.1, 1.0));
        vec3 ratios = rgb / light;
        rgb = shown * (saturation == 1.0 ? ratios : pow(max(ratios, 1e-12), vec3(finite(saturation))));
    }
    rgb = finite(rgb);
    return finite(premultiplied(vec4(clip ? clamp(rgb, 0.0, 1.0) : rgb, color.a)));
}
