// Colors that tell things apart by their numbers.
#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/hash.glsl"

// By chance, but never pale and never dark, and the first eight numbers well apart; black for 0, which is nothing.
vec3 id_color(float id) {
    if (id == 0.0) return vec3(0.0);
    vec3 chance = unit_float(pcg3d(uvec3(floatBitsToUint(id), 16u, 12u)));
    return with_hue(vec3(1.0, 0.05 + 0.3 * chance.y, 0.5), chance.x) * (0.3 + 0.7 * chance.z);
}
