#include "lib/finite.glsl"
#include "lib/noise.glsl"

float worley_distance(vec3 away, int metric) {
    away = abs(away);
    if (metric == METRIC_MANHATTAN) return away.x + away.y + away.z;
    return metric == METRIC_CHEBYSHEV ? max(max(away.x, away.y), away.z) : length(away);
}

void worley(
    int feature, int metric, float size, float jitter, int seed, float evolution,
    vec2 offset, vec2 period, float loop, out vec4 result, out float value, out vec3 cell
) {
    // Beyond a million cells, floats cannot resolve places within a cell.
    size = max(finite(size), 1e-3);
    vec3 tiles = vec3(finite(period) / size, finite(loop));
    ivec3 cells = lattice_period(tiles, 1.0, 1);
    vec3 p = lattice_place(vec2(pixel) + 0.5 - finite(offset), size, finite(period), finite(evolution), finite(loop));
    p = lattice_inside(clamp(p * lattice_density(tiles, 1.0, cells), -1e6, 1e6), cells);
    uvec3 stream = pcg3d(uvec3(uint(seed), 0u, 1u));
    float nearest = 1e9, second = 1e9;
    ivec3 middle = lattice_cell(p), winner = middle;
    for (int i = 0; i < 27; ++i) {
        ivec3 beside = ivec3(i % 3, i / 3 % 3, i / 9) - 1;
        vec3 point = 0.5 + clamp(finite(jitter), 0.0, 1.0) * (hash3(lattice_wrap(middle + beside, cells), stream) - 0.5);
        float far = worley_distance(vec3(beside) + point - fract(p), metric);
        if (far < nearest) winner = middle + beside;
        second = min(second, max(far, nearest));
        nearest = min(nearest, far);
    }
    value = feature == FEATURE_F1 ? nearest : feature == FEATURE_F2 ? second : second - nearest;
    cell = hash3(lattice_wrap(winner, cells), pcg3d(uvec3(uint(seed), 0u, 2u)));
    result = vec4(vec3(value), 1.0);
}
