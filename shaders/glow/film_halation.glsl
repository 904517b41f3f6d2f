#include "lib/bright.glsl"
#include "lib/shrinking.glsl"

// The light that passes through each color layer of the emulsion.
vec4 film_halation_light(vec4 image, vec3 threshold, float knee, float limit) {
    vec4 safe = finite(image);
    vec3 light = clamp(safe.rgb, 0.0, limit);
    for (int i = 0; i < 3; ++i) light[i] = light[i] > 0.0 ? bright_soft(light[i], threshold[i], knee) : 0.0;
    return vec4(light, safe.a);
}

vec4 film_halation_shrink(int factor) { return shrunk(factor); }

vec4 film_halation_none(vec4 light) { return vec4(0.0); }

vec4 film_halation_add(vec4 halo, vec4 soft, vec3 share) { return halo + vec4(soft.rgb * share, 0.0); }

vec4 film_halation_enlarge(int factor) { return enlarged(factor); }

vec4 film_halation_glow(vec4 image, vec4 halo, float amount, vec4 color) {
    return glow_alone(image, amount * color.rgb * max(halo.rgb, 0.0));
}

vec4 film_halation(vec4 image, vec4 glow) { return with_glow(image, glow.rgb); }
