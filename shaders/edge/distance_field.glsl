#include "lib/contour.glsl"
#include "lib/finite.glsl"

vec2 distance_field_seeds(float mask) { return contour_seeds(finite(mask), float(pixel.y)); }

vec2 distance_field_columns(int reach) {
    vec2 above = seeds_at(pixel - ivec2(0, reach)), below = seeds_at(pixel + ivec2(0, reach));
    return contour_nearer(contour_nearer(seeds_at(pixel), above, float(pixel.y)), below, float(pixel.y));
}

// Of what the columns found, the nearest: ever farther along the row, until no column can hold anything nearer.
float distance_field() {
    bool mine = columns_at(pixel).x == float(pixel.y);
    float nearest = dot(vec2(extent), vec2(extent));
    ivec2 seed = ivec2(-1);
    for (int away = 0; away < extent.x && float(away * away) < nearest; ++away)
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
    return (mine ? -far : far) / proxy;
}
