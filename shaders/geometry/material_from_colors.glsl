#include "lib/alpha.glsl"
#include "lib/finite.glsl"
#include "lib/color.glsl"

const float MATERIAL_PLAIN = 0.04;  // the reflectance of plastic, glass, paint: an index of refraction of 1.5
// Diffuse colors with a luminance below the first are black, above the second not. Charcoal and black velvet have 0.02
// to 0.04, dark leaves 0.1: a choice, since a black matte surface can not be told from a metal by its diffuse color.
const float MATERIAL_BLACK = 0.02, MATERIAL_COLORED = 0.1;

// A surface of color b, of which x is no metal, has the diffuse color b x and the glossy color b (1 - x) + 0.04 x. Both
// together are a quadratic equation for x. Of two solutions the one with less metal counts.
vec4 material_from_colors_glossy(vec4 matte, vec3 shiny) {
    vec3 sum = max(matte.rgb, 0.0) + max(shiny, 0.0);
    int channel = sum.r >= max(sum.g, sum.b) ? 0 : sum.g >= sum.b ? 1 : 2;
    float both = sum[channel], root = sqrt(max(both * both - 4.0 * MATERIAL_PLAIN * max(matte[channel], 0.0), 0.0));
    vec2 parts = vec2(both - root, both + root) / (2.0 * MATERIAL_PLAIN);
    float plain = both > 0.0 ? clamp(parts.y <= 1.0 ? parts.y : parts.x, 0.0, 1.0) : 1.0;
    return vec4(clamp(sum - MATERIAL_PLAIN * plain, 0.0, 1.0), 1.0 - plain);
}

// What is black and still gives light mirrors it, except for what it emits, and so has the hue of that light.
vec4 material_from_colors_light(vec4 matte, vec3 light, vec3 emitted, float reflectance) {
    vec3 mirrored = max(light - max(emitted, 0.0), 0.0);
    float whole = luminance(max(light, 0.0)), left = luminance(mirrored);
    float metal = 1.0 - smoothstep(MATERIAL_BLACK, MATERIAL_COLORED, luminance(matte.rgb));
    metal *= whole > 0.0 ? min(left / whole, 1.0) : 1.0;
    vec3 color = left > 0.0 ? reflectance * mirrored / left : vec3(0.0);
    return vec4(mix(matte.rgb, color, metal), metal);
}

void material_from_colors(
    vec4 diffuse_color, vec4 glossy_color, vec4 beauty, vec4 emission, float roughness, int metals, float reflectance,
    float roughen, float polish, out vec4 albedo, out vec2 material
) {
    vec4 matte = straight(finite(diffuse_color)), found;
    if (metals == METALS_GLOSSY_COLOR) {
        found = material_from_colors_glossy(matte, straight(finite(glossy_color)).rgb);
    } else {
        vec4 light = finite(beauty);
        matte = straight(vec4(finite(diffuse_color).rgb, clamp(light.a, 0.0, 1.0)));
        vec3 emitted = straight(vec4(finite(emission).rgb, light.a)).rgb;
        found = material_from_colors_light(matte, straight(light).rgb, emitted, clamp(finite(reflectance), 0.0, 1.0));
    }
    albedo = premultiplied(vec4(found.rgb, matte.a));
    material = vec2(found.a, clamp(finite(roughness) + finite(roughen) - found.a * finite(polish), 0.0, 1.0));
}
