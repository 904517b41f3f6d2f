#include "lib/finite.glsl"
#include "lib/footprint.glsl"

// The place beside a line that lies `u` along it, in its lengths, and `v` pixels beside it.
vec2 spline_warp_beside(vec4 line, float u, float v) {
    vec2 along = line.zw - line.xy;
    return line.xy + u * along + v * vec2(-along.y, along.x) / max(length(along), 1e-3);
}

// How far from each pixel its places in the two pictures are (xy and zw), by the formula of Beier and Neely 1992.
vec4 spline_warp_ways(int count, float reach, float falloff, float by_length) {
    vec2 at = vec2(pixel) + 0.5;
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < count; ++i) {
        ivec2 cell = ivec2(3 * (i % 4), i / 4);
        vec4 line = lines_at(cell), first = lines_at(cell + ivec2(1, 0)), second = lines_at(cell + ivec2(2, 0));
        vec2 along = line.zw - line.xy, away = at - line.xy;
        float size = max(length(along), 1e-3), u = dot(away, along) / (size * size);
        float v = dot(away, vec2(-along.y, along.x)) / size;
        float far = u < 0.0 ? length(away) : u > 1.0 ? distance(at, line.zw) : abs(v);
        float weight = pow(pow(size, by_length) / max(reach + far, 1e-3), falloff);
        sum += weight * (vec4(spline_warp_beside(first, u, v), spline_warp_beside(second, u, v)) - at.xyxy);
        total += weight;
    }
    return total > 0.0 ? clamp(finite(sum / total), -65536.0, 65536.0) : vec4(0.0);
}

vec4 spline_warp_way(ivec2 p) { return ways_at(clamp(p, ivec2(0), ways_size - 1)); }

vec4 spline_warp(float amount, int show) {
    ivec2 right = ivec2(1, 0), down = right.yx;
    vec4 here = vec4(vec2(pixel) + 0.5, vec2(pixel) + 0.5) + spline_warp_way(pixel);
    vec4 across = vec4(1.0, 0.0, 1.0, 0.0) + 0.5 * (spline_warp_way(pixel + right) - spline_warp_way(pixel - right));
    vec4 along = vec4(0.0, 1.0, 0.0, 1.0) + 0.5 * (spline_warp_way(pixel + down) - spline_warp_way(pixel - down));
    float part = show == SHOW_FIRST ? 0.0 : show == SHOW_SECOND ? 1.0 : amount;
    vec4 first = vec4(0.0), second = vec4(0.0);
    int n = footprint_samples(across.xy, along.xy), m = footprint_samples(across.zw, along.zw);
    for (int i = 0; part < 1.0 && i < n * n; ++i)
        first += image_near(here.xy + mat2(across.xy, along.xy) * footprint_at(i, n));
    for (int i = 0; part > 0.0 && i < m * m; ++i)
        second += other_near(here.zw + mat2(across.zw, along.zw) * footprint_at(i, m));
    return finite(mix(first / float(n * n), second / float(m * m), part));
}
