#include "lib/adaptation.glsl"
#include "lib/color.glsl"

float local_tone_map_luminance(vec4 image) { return luminance(metered(image).rgb); }

// The logarithm of luminance, and its weight.
vec2 local_tone_map_log(vec4 image) {
    vec4 light = metered(image);
    return light.a * vec2(log(1e-5 + luminance(light.rgb)), 1.0);
}

float local_tone_map_average(vec2 logs) { return logs.y > 0.0 ? exp(logs.x / logs.y) : 0.0; }

// The key, the factor that scales the average luminance to it, and the scaled white.
vec3 local_tone_map_scene(float average, float maximum, float key, bool auto_key, float nits) {
    average = max(finite(average), 1e-9);
    if (auto_key) key = natural_key(average * nits);
    return vec3(key, vec2(1.0, max(finite(maximum), 1e-9)) * key / average);
}

// Scaled luminance times its weight, and the weight, so that transparent areas do not affect the blurs.
vec2 local_tone_map_light(vec4 image, vec3 scene) {
    vec4 light = metered(image);
    return light.a * vec2(min(luminance(light.rgb) * scene.y, 1e9), 1.0);
}

float local_tone_map_mean(vec2 light) { return light.y > ALPHA_NONE ? max(light.x / light.y, 0.0) : 0.0; }

// How much the means of an area and of what is around it differ (Reinhard et al. 2002). Below the key, differences count
// less.
float local_tone_map_unevenness(float inner, float outer, vec3 scene, float scale, float sharpness) {
    return abs(inner - outer) / (exp2(sharpness) * scene.x / (scale * scale) + inner);
}

// The mean of the area so far, and 1 while the area may grow. The paper's smallest area is about a pixel; with a larger
// one, a pixel beside a lamp would be darkened by the light of the lamp, so the pixel alone is an area too.
vec2 local_tone_map_start(vec2 light, vec2 center, float scale, vec3 scene, float sharpness, float threshold) {
    float own = local_tone_map_mean(light), inner = local_tone_map_mean(center);
    return local_tone_map_unevenness(own, inner, scene, scale, sharpness) < threshold ? vec2(inner, 1.0) : vec2(own, 0.0);
}

// An area may grow to this size if its surround has a similar mean.
vec2 local_tone_map_grow(
    vec2 area, vec2 center, vec2 surround, float scale, vec3 scene, float sharpness, float threshold
) {
    float inner = local_tone_map_mean(center), outer = local_tone_map_mean(surround);
    float uneven = local_tone_map_unevenness(inner, outer, scene, scale, sharpness);
    return area.y > 0.0 && uneven < threshold ? vec2(inner, 1.0) : vec2(area.x, 0.0);
}

vec4 local_tone_map(vec4 image, vec2 area, vec3 scene, float saturation, bool clip) {
    vec4 color = straight(finite(image));
    vec3 rgb = clamp(color.rgb, 0.0, 1e9);
    float light = max(luminance(rgb), 1e-12);
    float keyed = light * scene.y, shown = keyed * (1.0 + keyed / (scene.z * scene.z)) / (1.0 + area.x);
    vec3 ratios = rgb / light;
    rgb = finite(shown * (saturation == 1.0 ? ratios : pow(max(ratios, 1e-12), vec3(saturation))));
    return finite(premultiplied(vec4(clip ? clamp(rgb, 0.0, 1.0) : rgb, color.a)));
}
