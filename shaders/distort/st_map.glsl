#include "lib/finite.glsl"
#include "lib/footprint.glsl"

// Beyond the border the map continues with its last pixels, whatever edge mode the picture has.
vec2 st_map_at(ivec2 p) { return finite(st_raw(clamp(p, ivec2(0), st_size - 1))); }

vec2 st_map_source(vec2 at, int origin) {
    vec2 corner = floor(at - 0.5), t = at - 0.5 - corner;
    ivec2 p = ivec2(corner);
    vec2 above = mix(st_map_at(p), st_map_at(p + ivec2(1, 0)), t.x);
    vec2 below = mix(st_map_at(p + ivec2(0, 1)), st_map_at(p + ivec2(1, 1)), t.x);
    vec2 st = mix(above, below, t.y);
    if (origin == ORIGIN_BOTTOM_LEFT) st.y = 1.0 - st.y;
    return clamp(st, -1e4, 1e4) * vec2(image_size);
}

vec4 st_map(int origin) {
    if (!is_finite(st_raw(pixel))) return vec4(0.0);
    vec2 at = vec2(pixel) + 0.5, right = vec2(0.5, 0.0), down = right.yx;
    int n = footprint_samples(
        st_map_source(at + right, origin) - st_map_source(at - right, origin),
        st_map_source(at + down, origin) - st_map_source(at - down, origin)
    );
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i) sum += image_near(st_map_source(at + footprint_at(i, n), origin));
    return finite(sum / float(n * n));
}
