#include "lib/alpha.glsl"
#include "lib/finite.glsl"

const float MATERIAL_PLAIN = 0.04;  // the reflectance of plastic, glass, paint: an index of refraction of 1.5

// A surface of color b, of which x is no metal, has the diffuse color b x and the glossy color b (1 - x) + 0.04 x. Both
// together are a quadratic equation for x. Of two solutions the one with less metal counts.
void material_from_colors(vec4 diffuse_color, vec4 glossy_color, float roughness, out vec4 albedo, out vec2 material) {
    vec4 matte = straight(finite(diffuse_color)), shiny = straight(finite(glossy_color));
    vec3 sum = max(matte.rgb, 0.0) + max(shiny.rgb, 0.0);
    int channel = sum.r >= max(sum.g, sum.b) ? 0 : sum.g >= sum.b ? 1 : 2;
    float both = sum[channel], root = sqrt(max(both * both - 4.0 * MATERIAL_PLAIN * max(matte[channel], 0.0), 0.0));
    vec2 parts = vec2(both - root, both + root) / (2.0 * MATERIAL_PLAIN);
    float plain = both > 0.0 ? clamp(parts.y <= 1.0 ? parts.y : parts.x, 0.0, 1.0) : 1.0;
    albedo = premultiplied(vec4(clamp(sum - MATERIAL_PLAIN * plain, 0.0, 1.0), matte.a));
    material = vec2(1.0 - plain, clamp(finite(roughness), 0.0, 1.0));
}
