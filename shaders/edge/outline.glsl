#include "lib/contour.glsl"
#include "lib/finite.glsl"

float outline_alpha(vec4 image) { return finite(image.a); }

vec2 outline_seeds(float mask) { return contour_seeds(finite(mask), float(pixel.y)); }

vec2 outline_columns(int reach) {
    vec2 above = seeds_at(pixel - ivec2(0, reach)), below = seeds_at(pixel + ivec2(0, reach));
    return contour_nearer(contour_nearer(seeds_at(pixel), above, float(pixel.y)), below, float(pixel.y));
}

// Distance to the contour, below 0 inside; `reach` where it is farther.
float outline_distance(int reach) {
    bool mine = columns_at(pixel).x == float(pixel.y);
    float nearest = float(reach * reach);
    ivec2 seed = ivec2(-1);
    for (int away = 0; float(away * away) < nearest; ++away)
        for (int side = -1; side <= 1; side += 2) {
            int x = pixel.x + side * away;
            if (x < 0 || x >= extent.x) continue;
            vec2 rows = columns_at(ivec2(x, pixel.y));
            float row = mine ? rows.y : rows.x, up = row - float(pixel.y), found = float(away * away) + up * up;
            if (row >= 0.0 && found < nearest) nearest = found, seed = ivec2(x, row);
        }
    float far = sqrt(nearest);
    if (seed.x >= 0)
        far -= contour_before(
            contour_covered(mask_at(seed), !mine), contour_covered(mask_at(seed + contour_step(pixel - seed)), !mine)
        );
    return mine ? -far : far;
}

// What of a pixel lies between two distances.
float outline_line(float contour, float first, float last, float fade) {
    vec2 past = clamp((contour - vec2(first, last)) / fade + 0.5, 0.0, 1.0);
    return past.x - past.y;
}

vec4 outline(vec4 image, float line, vec4 color, bool behind) {
    vec4 safe = finite(image), ink = vec4(color.rgb * color.a, color.a) * line;
    return finite(behind ? safe + ink * (1.0 - safe.a) : ink + safe * (1.0 - ink.a));
}
