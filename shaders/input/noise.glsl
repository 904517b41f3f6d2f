#include "lib/finite.glsl"
#include "lib/noise.glsl"

vec3 noise_layer(int kind, vec3 p, uvec3 stream, ivec3 period) {
    if (kind == KIND_VALUE) return value_noise(p, stream, period);
    if (kind == KIND_WHITE) return white_noise(p, stream, period);
    if (kind == KIND_SIMPLEX) return simplex_noise(p, stream, period);
    return gradient_noise(p, stream, period);
}

// Three independent noises, each within -1..1.
vec3 noise_layers(
    int kind, int fractal, vec3 place, vec3 tiles, int octaves, float lacunarity, float gain, float contrast, int seed
) {
    vec3 sum = vec3(0.0), carried = vec3(1.0);
    float strength = 1.0, density = 1.0, total = 0.0;
    for (int octave = 0; octave < min(octaves, 16); octave++) {
        uvec3 stream = pcg3d(uvec3(uint(seed), uint(octave), 0u));
        ivec3 period = lattice_period(tiles, density, kind == KIND_SIMPLEX ? SIMPLEX_STEP : 1);
        vec3 layer = noise_layer(kind, place * lattice_density(tiles, density, period), stream, period);
        if (fractal == FRACTAL_RIDGED || fractal == FRACTAL_TURBULENCE) layer = min(abs(layer * contrast), 1.0);
        if (fractal == FRACTAL_RIDGED) {
            layer = (1.0 - layer) * (1.0 - layer) * carried;
            carried = min(2.0 * layer, 1.0);  // finer layers only on ridges of coarser ones (Musgrave 1994)
        }
        sum += strength * layer;
        total += strength;
        strength *= gain;
        density *= lacunarity;
    }
    sum = finite(sum / max(total, 1e-6));
    if (fractal == FRACTAL_RIDGED || fractal == FRACTAL_TURBULENCE) return sum * 2.0 - 1.0;
    return clamp(sum * contrast, -1.0, 1.0);
}

void noise(
    int kind, float size, int octaves, float lacunarity, float gain, float contrast, int seed, float evolution,
    int fractal, float warp, vec2 offset, vec2 period, float loop, out vec4 result, out float value, out vec2 vector
) {
    lacunarity = finite(lacunarity);
    gain = finite(gain);
    contrast = finite(contrast);
    size = max(finite(size), 1e-3);
    vec3 place = lattice_place(vec2(pixel) + 0.5 - finite(offset), size, finite(period), finite(evolution), finite(loop));
    vec3 tiles = vec3(finite(period) / size, finite(loop));
    if (fractal == FRACTAL_WARPED) {
        vec3 bend = noise_layers(kind, fractal, place, tiles, octaves, lacunarity, gain, 1.0, seed);
        place.xy += finite(warp) * bend.yz;
    }
    vec3 sum = noise_layers(kind, fractal, place, tiles, octaves, lacunarity, gain, contrast, seed);
    value = 0.5 + 0.5 * sum.x;
    vector = sum.yz;
    result = vec4(vec3(value), 1.0);
}
