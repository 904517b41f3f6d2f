#include "lib/finite.glsl"
#include "lib/noise.glsl"

void noise(
    int kind, float size, int octaves, float lacunarity, float gain, float contrast, int seed, float evolution,
    out vec4 result, out float value, out vec2 vector
) {
    vec3 position = vec3((vec2(pixel) + 0.5) / max(finite(size), 1e-3), finite(evolution));
    vec3 sum = vec3(0.0);
    float strength = 1.0, total = 0.0;
    for (int octave = 0; octave < min(octaves, 16); octave++) {
        uvec3 stream = pcg3d(uvec3(uint(seed), uint(octave), 0u));
        if (kind == KIND_GRADIENT) sum += strength * gradient_noise(position, stream);
        if (kind == KIND_VALUE) sum += strength * value_noise(position, stream);
        if (kind == KIND_WHITE) sum += strength * white_noise(position, stream);
        total += strength;
        strength *= finite(gain);
        position *= finite(lacunarity);
    }
    sum = clamp(finite(sum / max(total, 1e-6)) * finite(contrast), -1.0, 1.0);
    value = 0.5 + 0.5 * sum.x;
    vector = sum.yz;
    result = vec4(vec3(value), 1.0);
}
