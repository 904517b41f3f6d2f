#include "lib/finite.glsl"
#include "lib/footprint.glsl"
#include "lib/noise.glsl"

const float noise_warp_reach = 65536.0;  // more pixels than any picture has: keeps wild masks within the range of int

// The direction in which each pixel moves, within -1..1 along each axis.
vec2 noise_warp_ways(int kind, float wave, int octaves, float gain, float evolution, float speed, int seed) {
    vec3 place = vec3((vec2(pixel) + 0.5) / wave, evolution + speed * float(frame));
    vec2 sum = vec2(0.0);
    float strength = 1.0, total = 0.0;
    for (int octave = 0; octave < octaves; ++octave) {
        uvec3 stream = pcg3d(uvec3(uint(seed), uint(octave), 0u));
        if (kind == KIND_PUSH) {
            sum += strength * simplex_noise(place, stream).xy;
        } else {
            vec2 slope = simplex_slope(place, stream).xy / SIMPLEX_STEEPEST;
            sum += strength * vec2(slope.y, -slope.x);
        }
        total += strength;
        strength *= gain;
        place.xy *= 2.0;
    }
    return sum / total;
}

vec2 noise_warp_way(ivec2 p) { return ways_at(clamp(p, ivec2(0), ways_size - 1)); }

vec4 noise_warp(float amount) {
    float far = amount * finite(mask_at(clamp(pixel, ivec2(0), mask_size - 1)));
    far = clamp(far, -noise_warp_reach, noise_warp_reach);
    vec2 source = vec2(pixel) + 0.5 + far * noise_warp_way(pixel);
    ivec2 right = ivec2(1, 0), down = right.yx;
    vec2 across = vec2(right) + 0.5 * far * (noise_warp_way(pixel + right) - noise_warp_way(pixel - right));
    vec2 along = vec2(down) + 0.5 * far * (noise_warp_way(pixel + down) - noise_warp_way(pixel - down));
    int n = footprint_samples(across, along);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i) sum += image_near(source + mat2(across, along) * footprint_at(i, n));
    return finite(sum / float(n * n));
}
