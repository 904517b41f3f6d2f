// Distance to the contour of a mask, the line where it crosses 0.5. First each pixel finds the nearest row in its
// column with a pixel inside the mask (x) and outside of it (y), by jump flooding (Rong and Tan 2006), which is exact
// along a line.

const float CONTOUR_NONE = -1.0;

// The start of the flooding: the own row as that of the nearest pixel inside, or outside.
vec2 contour_seeds(float mask, float row) { return mask >= 0.5 ? vec2(row, CONTOUR_NONE) : vec2(CONTOUR_NONE, row); }

// The nearer of two rows; CONTOUR_NONE is no row.
float contour_nearer(float a, float b, float row) {
    if (a < 0.0 || b < 0.0) return max(a, b);
    return abs(b - row) < abs(a - row) ? b : a;
}

vec2 contour_nearer(vec2 a, vec2 b, float row) {
    return vec2(contour_nearer(a.x, b.x, row), contour_nearer(a.y, b.y, row));
}

// The step from the nearest pixel of the other kind back to a pixel of this kind.
ivec2 contour_step(ivec2 way) {
    return abs(way.x) > abs(way.y) ? ivec2(sign(way.x), 0) : ivec2(0, sign(way.y));
}

// How far before the center of the nearest pixel of the other kind the contour lies: from the coverage of that pixel,
// or if it is covered fully, of the pixel one step back. Coverage is that of the other kind.
float contour_before(float covered, float covered_back) {
    return covered < 1.0 ? covered - 0.5 : 0.5 + covered_back;
}

// The coverage of a pixel by the inside (`kind` true) or the outside of the mask.
float contour_covered(float mask, bool kind) { return kind ? clamp(mask, 0.0, 1.0) : 1.0 - clamp(mask, 0.0, 1.0); }

// One step of jump flooding, in a pass that reads `seeds`: takes over the rows that the pixels `reach` above and below
// have found.
vec2 contour_columns(vec2 here, int reach) {
    vec2 above = seeds_at(pixel - ivec2(0, reach)), below = seeds_at(pixel + ivec2(0, reach));
    return contour_nearer(contour_nearer(here, above, float(pixel.y)), below, float(pixel.y));
}

// The distance to the contour, negative inside, at most `most`, in a pass that reads `columns` and `mask`. It walks
// along the row, away from the pixel, until no column can hold a nearer row.
float contour_distance(vec2 here, float most) {
    bool mine = here.x == float(pixel.y);
    float nearest = most * most;
    ivec2 seed = ivec2(-1);
    for (int away = 0; away < extent.x && float(away * away) < nearest; ++away)
        for (int side = -1; side <= 1; side += 2) {
            int x = pixel.x + side * away;
            if (x < 0 || x >= extent.x) continue;
            vec2 rows = columns_at(ivec2(x, pixel.y));
            float row = mine ? rows.y : rows.x, up = row - float(pixel.y), distance_squared = float(away * away) + up * up;
            if (row >= 0.0 && distance_squared < nearest) nearest = distance_squared, seed = ivec2(x, row);
        }
    float far = sqrt(nearest);
    if (seed.x >= 0)
        far -= contour_before(
            contour_covered(mask_at(seed), !mine), contour_covered(mask_at(seed + contour_step(pixel - seed)), !mine)
        );
    return mine ? -far : far;
}

// The nearest pixel inside the mask, or -1, in a pass that reads `columns`.
ivec2 contour_nearest(ivec2 here, int reach) {
    int nearest = reach * reach;
    ivec2 seed = ivec2(-1);
    for (int away = 0; away < extent.x && away * away < nearest; ++away)
        for (int side = -1; side <= 1; side += 2) {
            int x = here.x + side * away;
            if (x < 0 || x >= extent.x) continue;
            float row = columns_at(ivec2(x, here.y)).x;
            int up = int(row) - here.y, square = away * away + up * up;
            if (row >= 0.0 && square < nearest) nearest = square, seed = ivec2(x, int(row));
        }
    return seed;
}
