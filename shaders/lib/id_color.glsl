// Colors that distinguish ids.
#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/hash.glsl"

// A random color of an id, never pale or dark; the seeds give the first eight ids very different ones. Black for 0,
// which is no id.
vec3 id_color(float id) {
    if (id == 0.0) return vec3(0.0);
    vec3 chance = unit_float(pcg3d(uvec3(floatBitsToUint(id), 16u, 12u)));
    // Chosen by eye: what is mixed in keeps colors from being harsh, and the brightness is 30 % at least.
    return with_hue(vec3(1.0, 0.05 + 0.3 * chance.y, 0.5), chance.x) * (0.3 + 0.7 * chance.z);
}
