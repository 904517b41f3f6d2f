#include "lib/finite.glsl"
#include "lib/noise.glsl"
#include "lib/pi.glsl"

const float GABOR_NOISE_END = 0.04321392;  // exp(-pi): the Gaussian at its radius, which is taken away
const float GABOR_NOISE_ENERGY = 0.461243;  // the integral of the squared window over a disc of radius 1

// The sum of the waves that start in a cell. `away` is the way from its corner, `side` its size, both in radii.
float gabor_noise_cell(
    vec2 away, vec2 side, ivec3 cell, float turns, float angle, float spread, int waves, int seed, float moment
) {
    float sum = 0.0;
    for (int i = 0; i < min(waves, 64); ++i) {
        uvec3 stream = pcg3d(uvec3(uint(seed), uint(i), 3u));
        vec3 dice = hash3(cell, stream);
        vec2 p = away - dice.xy * side;
        float square = dot(p, p);
        if (square >= 1.0) continue;
        vec3 other = hash3(cell + ivec3(0, 0, 1), stream);
        float way = angle + spread * (2.0 * other.x - 1.0), phase = dice.z + (other.y < 0.5 ? moment : -moment);
        float wave = cos(2.0 * PI * (turns * dot(p, vec2(cos(way), sin(way))) + phase));
        sum += (exp(-PI * square) - GABOR_NOISE_END) / (1.0 - GABOR_NOISE_END) * wave;
    }
    return sum;
}

void gabor_noise(
    float wavelength, float radius, float angle, float spread, int waves, float contrast, int seed, float evolution,
    vec2 offset, vec2 period, out vec4 result, out float value
) {
    period = max(finite(period), 0.0);
    bvec2 repeats = greaterThan(period, vec2(0.0));
    float turns = clamp(finite(radius), 0.1, 64.0), reach = turns * max(finite(wavelength), 1e-3);
    // No wave is larger than the tile, and cells are no smaller than a radius: so it reaches into the next ones alone.
    float tile = min(repeats.x ? period.x : 1e30, repeats.y ? period.y : 1e30);
    turns *= min(reach, tile) / reach;
    reach = min(reach, tile);
    vec3 counts = vec3(max(floor(period / reach), 1.0), 1.0);
    ivec3 cells = ivec3(mix(vec3(LATTICE_PLAIN), counts, bvec3(repeats, false)));
    vec2 side = mix(vec2(1.0), period / (counts.xy * reach), repeats);
    vec3 place = lattice_place(vec2(pixel) + 0.5 - finite(offset), reach, period, 0.0, 0.0);
    vec2 p = lattice_inside(vec3(clamp(place.xy / side, -1e6, 1e6), 0.0), cells).xy, inside = fract(p);
    float sum = 0.0, moment = fract(finite(evolution));
    for (int i = 0; i < 9; ++i) {
        ivec2 beside = ivec2(i % 3, i / 3) - 1;
        ivec3 cell = lattice_wrap(ivec3(ivec2(floor(p)) + beside, 0), cells);
        vec2 away = (inside - vec2(beside)) * side;
        sum += gabor_noise_cell(away, side, cell, turns, finite(angle), finite(spread), waves, seed, moment);
    }
    float deviation = sqrt(float(max(waves, 1)) * GABOR_NOISE_ENERGY / (2.0 * side.x * side.y));
    value = finite(0.5 + 0.5 * clamp(finite(contrast) * sum / (3.0 * deviation), -1.0, 1.0));
    result = vec4(vec3(value), 1.0);
}
