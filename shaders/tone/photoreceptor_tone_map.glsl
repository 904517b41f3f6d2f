#include "lib/adaptation.glsl"
#include "lib/color.glsl"

const float photoreceptor_tone_map_dark = 1e-4;  // least luminance: black must not decide the result

vec4 photoreceptor_tone_map_light(vec4 image) {
    vec4 light = metered(image);
    return vec4(light.rgb * light.a, light.a);
}

float photoreceptor_tone_map_dim(vec3 rgb) { return log(max(luminance(rgb), photoreceptor_tone_map_dark)); }

float photoreceptor_tone_map_log(vec4 image) {
    vec4 light = metered(image);
    return light.a * photoreceptor_tone_map_dim(light.rgb);
}

// The terms of the maxima: the logarithm of luminance and its negative.
vec2 photoreceptor_tone_map_ends(vec4 image) {
    vec4 light = metered(image);
    return light.a > 0.0 ? vec2(1.0, -1.0) * photoreceptor_tone_map_dim(light.rgb) : vec2(-1e9);
}

// The average color, and the exponent m (Reinhard and Devlin 2005).
vec4 photoreceptor_tone_map_scene(float contrast, vec4 means, float logs, vec2 ends) {
    if (means.a <= 0.0) return vec4(0.0, 0.0, 0.0, 1.0);
    float range = ends.x + ends.y;  // from the darkest to the brightest
    float key = range > 0.0 ? clamp((ends.x - logs / means.a) / range, 0.0, 1.0) : 0.0;
    return vec4(means.rgb / means.a, contrast > 0.0 ? contrast : 0.3 + 0.7 * pow(key, 1.4));
}

// Like mix(), which may lose the smaller of two very different numbers.
vec3 photoreceptor_tone_map_blend(vec3 a, vec3 b, float share) { return (1.0 - share) * a + share * b; }

vec4 photoreceptor_tone_map(
    vec4 image, vec4 scene, float brightness, float light_adaptation, float color_adaptation
) {
    vec4 color = straight(finite(image));
    vec3 rgb = clamp(color.rgb, 0.0, 1e9);
    vec3 own = photoreceptor_tone_map_blend(vec3(luminance(rgb)), rgb, color_adaptation);
    vec3 others = photoreceptor_tone_map_blend(vec3(luminance(scene.rgb)), scene.rgb, color_adaptation);
    vec3 adapted = exp(-brightness) * photoreceptor_tone_map_blend(others, own, light_adaptation);
    rgb /= max(rgb + pow(max(adapted, 1e-12), vec3(scene.a)), 1e-12);
    return premultiplied(vec4(rgb, color.a));
}

// The terms of the maxima: the brightest channel and the negative of the darkest.
vec2 photoreceptor_tone_map_span(vec4 image) {
    vec4 color = straight(image);
    return color.a > ALPHA_NONE ? vec2(largest(color.rgb), -smallest(color.rgb)) : vec2(-1e9);
}

vec4 photoreceptor_tone_map_stretch(vec4 image, vec2 span) {
    vec4 color = straight(image);
    float range = span.x + span.y;
    return range > 1e-6 ? premultiplied(vec4(clamp((color.rgb + span.y) / range, 0.0, 1.0), color.a)) : image;
}
