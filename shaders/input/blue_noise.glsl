#include "lib/blue_noise.glsl"
#include "lib/finite.glsl"
#include "lib/hash.glsl"

// Each seed and frame starts at another place of the table. The two components of the vector start far from the value:
// steps of the R2 sequence (Roberts 2018) in 64ths.
void blue_noise(float size, int seed, bool animate, out vec4 result, out float value, out vec2 vector) {
    ivec2 cell = ivec2((vec2(pixel) + 0.5) / max(finite(size), 1.0));
    cell += ivec2(pcg3d(uvec3(uint(seed), animate ? uint(frame) : 0u, 0u)).xy & 63u);
    value = blue_noise(cell);
    vector = vec2(blue_noise(cell + ivec2(48, 36)), blue_noise(cell + ivec2(32, 8))) * 2.0 - 1.0;
    result = vec4(vec3(value), 1.0);
}
