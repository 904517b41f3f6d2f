#include "lib/alpha.glsl"
#include "lib/finite.glsl"
#include "lib/color.glsl"

const float MATERIAL_PLAIN = 0.04;  // the reflectance of plastic, glass, paint: an index of refraction of 1.5
// Diffuse colors with a luminance below the first are black, above the second not. Charcoal and black velvet have 0.02
// to 0.04, dark leaves 0.1: a choice, since a black matte surface can not be told from a metal by its diffuse color.
const float MATERIAL_BLACK = 0.02, MATERIAL_COLORED = 0.1;

const int MATERIAL_REACH = 2;         // pixels beside an edge: filters of renderers are up to three pixels wide
const float MATERIAL_METAL = 0.9;     // a pixel that stands for a metal is metal by that much at least
const float MATERIAL_MISFIT = 0.1;    // parts of a color: what differs by more from a darker one is another surface
const ivec2 MATERIAL_WAYS[8] = ivec2[8](
    ivec2(1, 0), ivec2(0, 1), ivec2(-1, 0), ivec2(0, -1), ivec2(1, 1), ivec2(-1, 1), ivec2(-1, -1), ivec2(1, -1)
);

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

// The diffuse color of the surface, straight, with the alpha of the pixel.
vec4 material_from_colors_matte(vec4 diffuse_color, vec4 beauty, int metals) {
    vec4 matte = finite(diffuse_color);
    return straight(metals == METALS_GLOSSY_COLOR ? matte : vec4(matte.rgb, clamp(finite(beauty).a, 0.0, 1.0)));
}

// The color of the surface, and how much of it is metal.
vec4 material_from_colors_found(
    vec4 diffuse_color, vec4 glossy_color, vec4 beauty, vec4 emission, int metals, float reflectance
) {
    vec4 matte = material_from_colors_matte(diffuse_color, beauty, metals), light = finite(beauty);
    if (metals == METALS_GLOSSY_COLOR)
        return material_from_colors_glossy(matte, straight(finite(glossy_color)).rgb);
    vec3 emitted = straight(vec4(finite(emission).rgb, light.a)).rgb;
    return material_from_colors_light(matte, straight(light).rgb, emitted, clamp(finite(reflectance), 0.0, 1.0));
}

// The same where a renderer has filtered the edge of a metal: its diffuse color is that of the surface beside it, made
// darker by as much as the metal covers. Both lie on opposite sides, at most MATERIAL_REACH pixels away.
vec4 material_from_colors_edges(int metals) {
    vec4 found = found_at(pixel), matte = material_from_colors_matte(diffuse_color_at(pixel), beauty_at(pixel), metals);
    float least = MATERIAL_MISFIT;
    for (int i = 0; i < 8 * MATERIAL_REACH && found.a < MATERIAL_METAL; ++i) {
        ivec2 way = MATERIAL_WAYS[i & 7] * (1 + (i >> 3));
        vec4 metal = found_at(pixel + way), plain = found_at(pixel - way);
        if (metal.a < MATERIAL_METAL || plain.a > 1.0 - MATERIAL_METAL) continue;
        float size = dot(plain.rgb, plain.rgb), part = dot(matte.rgb, plain.rgb) / max(size, 1e-20);
        float misfit = length(matte.rgb - part * plain.rgb) / sqrt(max(size, 1e-20));
        if (part >= 1.0 || misfit >= least) continue;
        least = misfit;
        found = vec4(matte.rgb + (1.0 - part) * metal.rgb, 1.0 - part);
    }
    return found;
}

vec4 material_from_colors_albedo(vec4 diffuse_color, vec4 beauty, vec4 found, int metals) {
    return premultiplied(vec4(found.rgb, material_from_colors_matte(diffuse_color, beauty, metals).a));
}

vec2 material_from_colors_material(float roughness, vec4 found, float roughen, float polish) {
    return vec2(found.a, clamp(finite(roughness) + finite(roughen) - found.a * finite(polish), 0.0, 1.0));
}
