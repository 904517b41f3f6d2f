#include "lib/finite.glsl"
#include "lib/noise.glsl"

void curl_noise(
    float size, int octaves, float lacunarity, float gain, float strength, int seed, float evolution,
    vec2 offset, vec2 period, float loop, out vec2 vector, out float stream
) {
    size = max(finite(size), 1e-3);
    vec3 place = lattice_place(vec2(pixel) + 0.5 - finite(offset), size, finite(period), finite(evolution), finite(loop));
    vec3 tiles = vec3(finite(period) / size, finite(loop)), sum = vec3(0.0);
    float height = 1.0, density = 1.0, total = 0.0;
    for (int octave = 0; octave < min(octaves, 16); octave++) {
        ivec3 cells = lattice_period(tiles, density, SIMPLEX_STEP);
        vec3 dense = lattice_density(tiles, density, cells);
        vec4 layer = simplex_slope(place * dense, pcg3d(uvec3(uint(seed), uint(octave), 0u)), cells);
        // Chain rule: the slope of a layer grows with its frequency.
        sum += height * vec3(dense.y * layer.y, -dense.x * layer.x, layer.w);
        total += height * max(density, max(dense.x, dense.y));
        height *= finite(gain);
        density *= finite(lacunarity);
    }
    sum = finite(sum * (finite(strength) / (total * SIMPLEX_STEEPEST)));
    vector = sum.xy;
    stream = sum.z;
}
