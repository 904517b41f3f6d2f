#include "lib/adaptation.glsl"
#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/agx.glsl"

// Display luminance for scene luminance; both are above 0.
float tone_map_luminance(
    int operator, float light, float key, float average, float maximum, float bias, float q, float k
) {
    float keyed = light * key / average, white = maximum * key / average;
    if (operator == OPERATOR_REINHARD) return keyed / (1.0 + keyed);
    if (operator == OPERATOR_REINHARD_EXTENDED) return keyed * (1.0 + keyed / (white * white)) / (1.0 + keyed);
    if (operator == OPERATOR_REINHARD_UNSQUARED) return keyed * (1.0 + keyed / white) / (1.0 + keyed);
    if (operator == OPERATOR_EXPONENTIAL) return 1.0 - exp(-keyed);
    if (operator == OPERATOR_LOGARITHMIC) return log(1.0 + q * light) / log(1.0 + k * maximum);
    // Drago et al. 2003: the base of the logarithm goes from 2 in shadows to 10 at the maximum, on a display of 100
    // cd/m2.
    float power = log(bias) / log(0.5);
    float base = 2.0 + 8.0 * pow(light / maximum, power);
    return log(light / average + 1.0) / log(base) / (log(maximum / average + 1.0) / log(10.0));
}

// ACES RRT and sRGB ODT (fit by Hill). Matrices are written by rows and multiplied from the left.
vec3 tone_map_aces(vec3 rgb) {
    vec3 v = to_rec709(rgb) * mat3(0.59719, 0.35458, 0.04823, 0.07600, 0.90834, 0.01566, 0.02840, 0.13383, 0.83777);
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return from_rec709(v * mat3(1.60475, -0.53108, -0.07367, -0.10208, 1.10813, -0.00605, -0.00327, -0.07276, 1.07602));
}

// Khronos PBR Neutral: subtracts the Fresnel reflection of 4 %, compresses above 0.8, and fades the brightest light to
// white.
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

// The ACES fit of Narkowicz (2015). Light is multiplied by 0.6, as its author suggests, for the exposure of ACES.
vec3 tone_map_narkowicz(vec3 x) {
    x *= 0.6;
    return x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14);
}

// Uchimura (2017): toe, straight line and shoulder, joined smoothly, with the published parameters for a display with
// white 1.
float tone_map_uchimura(float x, float slope) {
    const float middle = 0.22, share = 0.4, tightness = 1.33;
    float span = (1.0 - middle) * share / slope, end = middle + span, shown = middle + slope * span;
    if (x >= end) return 1.0 - (1.0 - shown) * exp(-slope / (1.0 - shown) * (x - end));
    float line = middle + slope * (x - middle);
    if (x >= middle) return line;
    return mix(middle * pow(max(x, 1e-12) / middle, tightness), line, smoothstep(0.0, middle, x));
}

vec3 tone_map_uchimura(vec3 x, float slope) {
    return vec3(tone_map_uchimura(x.r, slope), tone_map_uchimura(x.g, slope), tone_map_uchimura(x.b, slope));
}

// Lottes (2016): x^a / (b x^(a d) + c). b and c are such that 0.18 becomes 0.267 and white becomes 1.
vec3 tone_map_lottes(vec3 x, float contrast, float white) {
    const float gray = 0.18, shown = 0.267, shoulder = 0.977;
    float a = 1.6 * contrast, ad = a * shoulder;
    white = max(white, 2.0 * gray);
    float span = (pow(white, ad) - pow(gray, ad)) * shown;
    float b = (pow(white, a) * shown - pow(gray, a)) / span;
    float c = (pow(white, ad) * pow(gray, a) - pow(white, a) * pow(gray, ad) * shown) / span;
    return pow(max(x, 1e-12), vec3(a)) / (b * pow(max(x, 1e-12), vec3(ad)) + c);
}

vec4 tone_map(
    vec4 image, int operator, float exposure, float key, bool auto_key, float nits, float average, float maximum,
    float bias, float q, float k, float contrast, float saturation, bool clip
) {
    vec4 color = straight(finite(image));
    vec3 rgb = min(max(color.rgb, 0.0) * exp2(clamp(finite(exposure), -64.0, 64.0)), 1e9);
    average = max(finite(average), 1e-9), maximum = max(finite(maximum), 1e-9);
    contrast = clamp(finite(contrast), 0.25, 3.0);
    if (operator == OPERATOR_ACES) rgb = tone_map_aces(rgb);
    else if (operator == OPERATOR_ACES_NARKOWICZ) rgb = tone_map_narkowicz(rgb);
    else if (operator == OPERATOR_AGX) rgb = agx(rgb);
    else if (operator == OPERATOR_KHRONOS_NEUTRAL) rgb = tone_map_neutral(rgb);
    else if (operator == OPERATOR_HABLE) rgb = tone_map_hable(2.0 * rgb) / tone_map_hable(vec3(11.2));
    else if (operator == OPERATOR_UCHIMURA) rgb = tone_map_uchimura(rgb, contrast);
    else if (operator == OPERATOR_LOTTES) rgb = tone_map_lottes(rgb, contrast, maximum);
    else {
        float light = max(luminance(rgb), 1e-12);
        if (auto_key) key = natural_key(average * finite(nits));
        bias = clamp(finite(bias), 0.1, 1.0), q = max(finite(q), 1e-3), k = max(finite(k), 1e-3);
        float shown = tone_map_luminance(operator, light, finite(key), average, maximum, bias, q, k);
        vec3 ratios = rgb / light;
        rgb = shown * (saturation == 1.0 ? ratios : pow(max(ratios, 1e-12), vec3(finite(saturation))));
    }
    rgb = finite(rgb);
    return finite(premultiplied(vec4(clip ? clamp(rgb, 0.0, 1.0) : rgb, color.a)));
}
