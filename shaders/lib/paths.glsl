// Closed outlines as coverage. Tables say what matters in each tile: `outline_tables.py` makes them.
//
// Coverage is the area right of each segment, with its sign, summed over the segments of a row: exact for polygons, as
// in Levien's font-rs. What lies left of a tile is a number for each row. Soft edges are a function of the distance to
// the nearest chord; where points have feathers, to that which is nearest for its feather. So the edge has no steps where
// another part of the outline becomes the nearest one.

#include "lib/finite.glsl"

const int PATH_TILE = 16, PATH_STRIP = 4, PATH_ENTRY = 10;
const int PATH_MOST = 32;  // chords near four pixels that are kept; where more are near, all of the tile are tried
const float PATH_PART = 0.0625;  // the side of one of 256 parts of a pixel
const float PATH_CORNER = 0.7072;  // from the middle of a pixel to its corners
const float PATH_LEVEL = 1.0 / 256.0;  // parts of the feather in a pixel: less is too little for 32 bits
const float PATH_FLAT = 0.002, PATH_EVEN = 0.03;  // parts of the feather that places may be from even
const float PATH_STEEP = 1.0 / 512.0;  // pixels across a row from which on a segment is slanted: else 32 bits are too few

// Where a texel is in a table of 2^bits texels in a row.
ivec2 path_cell(int number, int bits) { return ivec2(number & ((1 << bits) - 1), number >> bits); }

// The area in four pixels, right and below of `corner`, that lies right of a segment; above 0 if that runs down.
vec4 path_area(vec4 segment, vec2 corner) {
    vec4 part = segment - corner.xyxy;
    vec2 rows = clamp(part.yw, 0.0, 1.0);
    vec2 t = (rows - part.y) / (part.w - part.y);
    vec2 ends = clamp(part.x + t * (part.z - part.x), min(part.x, part.z), max(part.x, part.z));
    float width = abs(ends.y - ends.x);
    vec4 low = min(ends.x, ends.y) - vec4(0.0, 1.0, 2.0, 3.0), high = low + width;
    vec4 start = clamp(low, 0.0, 1.0), end = clamp(high, 0.0, 1.0);
    vec4 slanted = (clamp(-low, 0.0, width) + (end - start) * (1.0 - 0.5 * (start + end))) / max(width, PATH_STEEP);
    vec4 share = width < PATH_STEEP ? 1.0 - clamp(0.5 * (low + high), 0.0, 1.0) : slanted;
    return (rows.y - rows.x) * share;
}

const int PATH_UNION = 0, PATH_SUBTRACT = 1, PATH_INTERSECT = 2, PATH_MAX = 3, PATH_MIN = 4, PATH_DIFFERENCE = 5;
const int PATH_PLUS = 6;

// What a shape does to a mask, in one number: the mode twice, and how much of the mask stays, or how much of the shape
// is added to it or taken away. The mode that is most used is 0, which keeps all bits.
vec4 path_pack(vec4 cover, int mode, float opacity, bool invert) {
    if (invert) cover = 1.0 - cover;
    vec4 amount = mode == PATH_INTERSECT || mode == PATH_MIN ? 1.0 - opacity * (1.0 - cover) : cover * opacity;
    return clamp(amount, 0.0, 1.0) + 2.0 * float(mode);
}

// A mask with one more shape; the last mode is their sum.
float path_combine(float below, float change) {
    int mode = min(int(0.5 * change), PATH_PLUS);
    float amount = change - 2.0 * float(mode);
    if (mode == PATH_UNION) return below + amount * (1.0 - below);
    if (mode == PATH_SUBTRACT) return below * (1.0 - amount);
    if (mode == PATH_INTERSECT) return below * amount;
    if (mode == PATH_MAX) return max(below, amount);
    if (mode == PATH_MIN) return min(below, amount);
    if (mode == PATH_DIFFERENCE) return abs(below - amount);
    return min(below + amount, 1.0);
}

// The distance of four pixels to the nearest of some chords. `place` is the middle of the first pixel.
void path_nearest(int first, int count, vec2 place, int bits, out vec4 distances) {
    vec4 squares = vec4(1e30), across = place.x + vec4(0.0, 1.0, 2.0, 3.0);
    for (int n = first; n < first + count; ++n) {
        vec4 four = nearest_at(path_cell(n, bits));
        for (int k = 0; k < 4; ++k) {
            vec4 ends = chords_at(path_cell(2 * int(four[k]), bits));
            vec2 edge = ends.zw - ends.xy;
            vec4 x = across - ends.x;
            float y = place.y - ends.y;
            vec4 t = clamp((x * edge.x + y * edge.y) / max(dot(edge, edge), 1e-12), 0.0, 1.0);
            x -= t * edge.x;
            vec4 away = y - t * edge.y;
            squares = min(squares, x * x + away * away);
        }
    }
    distances = sqrt(squares);
}

// A chord at four places: where its distance is the least part of its feather so far, the squares of the distance in parts
// of the feather and in pixels, and the feather. No edge counts as narrower than a pixel. Both the place and the feather
// change evenly on a chord, so the square of the quotient has one minimum.
void path_approach(
    vec4 ends, vec2 width, vec4 from_x, vec4 from_y, inout vec4 least, inout vec4 squares, inout vec4 feathers
) {
    vec2 wide = max(width, 1.0), edge = ends.zw - ends.xy;
    float growth = wide.y - wide.x;
    vec4 x = from_x - ends.x, y = from_y - ends.y, run = x * edge.x + y * edge.y;
    vec4 slope = dot(edge, edge) * wide.x + growth * run;
    vec4 t = (growth * (x * x + y * y) + run * wide.x) / max(slope, 1e-12);
    t = mix(vec4(growth > 0.0 ? 1.0 : 0.0), clamp(t, 0.0, 1.0), greaterThan(slope, vec4(0.0)));
    x -= t * edge.x;
    y -= t * edge.y;
    vec4 there = wide.x + t * growth, square = x * x + y * y, relative = square / (there * there);
    bvec4 nearer = lessThan(relative, least);
    least = mix(least, relative, nearer);
    squares = mix(squares, square, nearer);
    feathers = mix(feathers, mix(vec4(width.x), vec4(width.y), t), nearer);
}

// The distance for chords whose feathers differ: the least one for the feather there, which is `feather` more than that
// of the chord.
void path_nearest_wide(
    int first, int count, vec2 place, int bits, float feather, out vec4 distances, out vec4 feathers
) {
    vec4 least = vec4(1e30), squares = vec4(1e30), across = place.x + vec4(0.0, 1.0, 2.0, 3.0);
    feathers = vec4(feather);
    for (int n = first; n < first + count; ++n) {
        vec4 four = nearest_at(path_cell(n, bits));
        for (int k = 0; k < 4; ++k) {
            int chord = 2 * int(four[k]);
            vec2 width = chords_at(path_cell(chord + 1, bits)).xy + feather;
            path_approach(chords_at(path_cell(chord, bits)), width, across, vec4(place.y), least, squares, feathers);
        }
    }
    distances = sqrt(squares);
}

// The integral of the soft edge 3 t^2 - 2 t^3.
vec4 path_integral(vec4 t) {
    vec4 u = clamp(t, 0.0, 1.0);
    return u * u * u * (1.0 - 0.5 * u) + max(t - 1.0, 0.0);
}

// The mean of soft edges over `width` pixels across them, at distances in pixels that are above 0 inside.
vec4 path_average(vec4 inside, vec4 feathers, float width) {
    vec4 t = 0.5 + inside / feathers, part = 0.5 * width / feathers;
    return (path_integral(t + part) - path_integral(t - part)) * feathers / width;
}

// The coverage of soft edges, if the distance changes evenly in a pixel. Below one pixel of feather the exact coverage
// takes over.
vec4 path_soften(vec4 cover, vec4 inside, vec4 feathers) {
    vec4 soft = mix(cover, path_average(inside, max(feathers, 1e-6), 1.0), min(feathers, 1.0));
    return mix(soft, cover, lessThanEqual(feathers, vec4(0.0)));
}

// The chords that can be nearest to a place in one of four pixels: whose distance in parts of the feather can be below a
// limit. If there are more than PATH_MOST, as many are kept, and the number of all is returned.
int path_gather(int first, int count, vec2 place, int bits, float feather, vec4 limits, out int near[PATH_MOST]) {
    int found = 0, before = -1;
    vec4 across = place.x + vec4(0.0, 1.0, 2.0, 3.0);
    for (int n = first; n < first + count; ++n) {
        vec4 four = nearest_at(path_cell(n, bits));
        for (int k = 0; k < 4; ++k) {
            int chord = int(four[k]);
            if (chord == before) continue;
            before = chord;
            vec4 ends = chords_at(path_cell(2 * chord, bits));
            vec2 edge = ends.zw - ends.xy, width = chords_at(path_cell(2 * chord + 1, bits)).xy + feather;
            vec4 x = across - ends.x;
            float y = place.y - ends.y;
            vec4 t = clamp((x * edge.x + y * edge.y) / max(dot(edge, edge), 1e-12), 0.0, 1.0);
            x -= t * edge.x;
            vec4 away = y - t * edge.y, reach = limits * max(max(width.x, width.y), 1.0) + PATH_CORNER;
            if (!any(lessThanEqual(x * x + away * away, reach * max(reach, 0.0)))) continue;
            if (found < PATH_MOST) near[found] = chord;
            ++found;
        }
    }
    return found;
}

// The side of a chord on which four places are, where it is the nearest one. Of two with the same nearest end, that
// counts which they are farther beside.
void path_side(vec4 ends, vec4 from_x, vec4 from_y, inout vec4 nearest, inout vec4 sides) {
    vec2 edge = ends.zw - ends.xy;
    float square = max(dot(edge, edge), 1e-12);
    vec4 x = from_x - ends.x, y = from_y - ends.y, aside = edge.x * y - edge.y * x;
    vec4 t = clamp((x * edge.x + y * edge.y) / square, 0.0, 1.0);
    x -= t * edge.x;
    y -= t * edge.y;
    vec4 rank = x * x + y * y - 1e-4 * aside * aside / square;
    bvec4 nearer = lessThan(rank, nearest);
    nearest = mix(nearest, rank, nearer);
    sides = mix(sides, aside, nearer);
}

// How far inside of the edge four places are, in pixels, and the feather there. `side` is 0 where the edge runs through
// the pixel, else as `turn` where it is inside.
vec4 path_inside(
    int first, int count, int bits, float feather, const int near[PATH_MOST], int found, vec4 x, vec4 y, float side,
    float turn, out vec4 feathers
) {
    vec4 least = vec4(1e30), squares = vec4(1e30), nearest = vec4(1e30), sides = vec4(side);
    int last = found > PATH_MOST ? 4 * count : found;
    feathers = vec4(feather);
    for (int n = 0; n < last; ++n) {
        int chord = found > PATH_MOST ? int(nearest_at(path_cell(first + (n >> 2), bits))[n & 3]) : near[n];
        vec4 ends = chords_at(path_cell(2 * chord, bits));
        vec2 width = chords_at(path_cell(2 * chord + 1, bits)).xy + feather;
        path_approach(ends, width, x, y, least, squares, feathers);
        if (side == 0.0) path_side(ends, x, y, nearest, sides);
    }
    vec4 away = sqrt(squares);
    feathers = max(feathers, 0.25 * PATH_PART);
    return mix(-away, away, greaterThanEqual(sides * turn, vec4(0.0)));
}

// Of the chords near a pixel those that can be nearest to a place in one of its 16 squares; more than PATH_MOST as above.
int path_select(
    int first, int count, int bits, float feather, const int near[PATH_MOST], int found, vec2 middle, float limit,
    float least, out int list[PATH_MOST]
) {
    int listed = 0, last = found > PATH_MOST ? 4 * count : found;
    for (int n = 0; n < last; ++n) {
        int chord = found > PATH_MOST ? int(nearest_at(path_cell(first + (n >> 2), bits))[n & 3]) : near[n];
        vec4 ends = chords_at(path_cell(2 * chord, bits));
        vec2 edge = ends.zw - ends.xy, width = chords_at(path_cell(2 * chord + 1, bits)).xy + feather;
        vec2 rest = middle - ends.xy;
        rest -= edge * clamp(dot(rest, edge) / max(dot(edge, edge), 1e-12), 0.0, 1.0);
        float reach = limit * max(max(width.x, width.y), 1.0) + 0.25 * PATH_CORNER;
        reach = max(reach, least);
        if (dot(rest, rest) > reach * reach) continue;
        if (listed < PATH_MOST) list[listed] = chord;
        ++listed;
    }
    return listed;
}

// The mean over a pixel of an edge whose place changes evenly: over 16 strips along its steeper side, each exact.
float path_even(float middle, vec2 slope) {
    vec2 side = abs(slope);
    float steep = max(max(side.x, side.y), PATH_LEVEL);
    vec4 total = vec4(0.0);
    for (int row = 0; row < 4; ++row) {
        vec4 across = vec4(-0.46875, -0.21875, 0.03125, 0.28125) + 0.0625 * float(row);
        vec4 t = 0.5 + middle + min(side.x, side.y) * across;
        total += (path_integral(t + 0.5 * steep) - path_integral(t - 0.5 * steep)) / steep;
    }
    return dot(total, vec4(0.0625));
}

// The coverage of a soft edge in a pixel, by the distance in parts of the feather. By its middle and corners if it
// changes evenly; else by the mean at 16 places, in rows and columns of their own, as far as it is not that of an even
// edge; if it differs much from that, by the mean at 256 places.
float path_divide(
    int first, int count, int bits, float feather, const int near[PATH_MOST], int found, vec2 middle, float cover,
    float inside_middle, float width, float turn
) {
    bool is_crossed = cover > 1e-4 && cover < 1.0 - 1e-4;
    float side = is_crossed ? 0.0 : cover < 0.5 ? -turn : turn, hardness = is_crossed ? 1.0 - min(width, 1.0) : 0.0;
    float least = 1e30, uneven = 0.0, mean = inside_middle / max(width, 0.25 * PATH_PART), even_feather = 0.0;
    vec4 feathers, few = vec4(0.0), many = vec4(0.0), steps = vec4(-1.5, -0.5, 0.5, 1.5);
    vec2 slope = vec2(0.0);
    int list[PATH_MOST] = near, listed = found;
    vec4 limits = vec4(0.0), besides = limits;  // besides: so near is what says on which side a place is
    for (int row = -1; row < 72; ++row) {
        int band = (row - 4) / 17, at = (row - 4) % 17 - 1;  // of a band of four squares first the middles
        bool is_small = row >= 4;
        float down = float(row & 3) - 1.5;
        vec4 x = 0.25 * (steps + 0.25 * down), y = 0.25 * (down - 0.25 * steps);
        if (row < 0) x = vec4(-0.5, 0.5, -0.5, 0.5);
        if (row < 0) y = x.xxyy;
        if (is_small) {
            vec2 corner = 0.25 * vec2(at >> 2, band) - 0.375;
            if (at < 0) {
                list = near;
                listed = found;
            } else if ((at & 3) == 0) {
                listed = path_select(
                    first, count, bits, feather, near, found, middle + corner, limits[at >> 2],
                    besides[at >> 2], list
                );
            }
            x = at < 0 ? 0.25 * steps : corner.x + PATH_PART * steps;
            y = vec4(at < 0 ? corner.y : corner.y + PATH_PART * (float(at & 3) - 1.5));
        }
        vec4 inside = path_inside(
            first, count, bits, feather, list, listed, middle.x + x, middle.y + y, side, turn, feathers
        );
        if (is_small && at < 0) {
            if (is_crossed) besides = abs(inside) + 0.5 * PATH_CORNER;
            limits = (abs(inside) + 0.25 * PATH_CORNER) / max(feathers, 1.0);
            continue;
        }
        vec4 place = inside / feathers, soft = path_average(inside, feathers, PATH_PART);
        if (is_small) {
            many += soft + hardness * (cover - clamp(0.5 + inside / PATH_PART, 0.0, 1.0));
            continue;
        }
        vec4 far = abs(place);
        least = min(least, min(min(far.x, far.y), min(far.z, far.w)));
        if (row < 0) {
            float corners = dot(place, vec4(0.25));
            slope = 0.5 * vec2(dot(place, vec4(-1.0, 1.0, -1.0, 1.0)), dot(place, vec4(-1.0, -1.0, 1.0, 1.0)));
            vec2 bend = 0.5 * (place.xy + place.wz) - mean;
            if (max(abs(bend.x), abs(bend.y)) < PATH_FLAT)
                return width < 0.25 * PATH_PART ? cover : path_even(mix(mean, corners, 1.0 / 3.0), slope);
            mean = corners;
            even_feather = 1.0 / max(length(slope), PATH_LEVEL);
            continue;
        }
        vec4 even = mean + slope.x * x + slope.y * y, differ = abs(place - even);
        uneven = max(uneven, max(max(differ.x, differ.y), max(differ.z, differ.w)));
        few += soft - path_average(even * even_feather, vec4(even_feather), PATH_PART);
        if (row == 3 && side != 0.0 && least > 0.5) return cover < 0.5 ? 0.0 : 1.0;
        if (row == 3 && uneven < PATH_EVEN) return dot(few, vec4(0.0625)) + path_even(mean, slope);
    }
    return dot(many, vec4(1.0 / 256.0));
}

// Four pixels of a tile in which the distance may not change evenly.
vec4 path_refine(
    int first, int count, vec2 place, int bits, float feather, vec4 cover, vec4 soft, vec4 inside, vec4 feathers,
    float turn, float narrowest
) {
    vec4 wide = max(feathers, 1.0), limits = (abs(inside) + PATH_CORNER) / wide;
    bvec4 is_near = lessThan(abs(inside) / wide, vec4(0.5 + PATH_CORNER / narrowest));
    if (!any(is_near)) return soft;
    int near[PATH_MOST];
    int found = path_gather(first, count, place, bits, feather, mix(vec4(-1e15), limits, is_near), near);
    for (int n = 0; n < 4; ++n) {
        if (!is_near[n]) continue;
        vec2 middle = place + vec2(float(n), 0.0);
        soft[n] = path_divide(
            first, count, bits, feather, near, found, middle, cover[n], inside[n], feathers[n], turn
        );
    }
    return soft;
}

// What an outline does to four pixels beside each other, packed: four texels by sixteen for each entry of a tile, 2^across
// of which lie side by side.
vec4 path_find_covers(int bits, int across, int count, int beyond, bool is_fine) {
    ivec2 block = pixel >> ivec2(2, 4), within = ivec2(4, 1) * (pixel & ivec2(3, 15));
    int number = (block.y << across) + block.x;
    if (number >= count) return vec4(0.0);
    int at = PATH_ENTRY * number, strip = at + 2 + 2 * (within.y >> 2);
    vec4 entry = entries_at(path_cell(at, bits)), segments = entries_at(path_cell(strip, bits));
    vec4 sum = vec4(entries_at(path_cell(strip + 1, bits))[within.y & 3]);
    vec2 corner = vec2(within.x, within.y & 3);
    int first = int(segments.x), last = first + int(segments.y);
    for (int n = first; n < last; ++n) sum += path_area(segments_at(path_cell(n, bits)), corner);
    vec4 cover = min(abs(sum), 1.0);
    vec4 facts = shapes_at(path_cell(2 * int(entry.x), bits));
    int mode = int(facts.x);
    bool invert = facts.z > 0.5;
    if (entry.z == 0.0) return path_pack(cover, mode, facts.y, invert);
    vec2 tile = entries_at(path_cell(at + 1, bits)).xy - float(beyond);
    vec3 more = shapes_at(path_cell(2 * int(entry.x) + 1, bits)).xyz;  // growth, whether points have feathers, turn
    vec2 place = tile * float(PATH_TILE) + vec2(within) + 0.5;
    vec4 distances, feathers = vec4(facts.w);
    if (more.y > 0.0) path_nearest_wide(int(entry.y), int(entry.z), place, bits, facts.w, distances, feathers);
    else path_nearest(int(entry.y), int(entry.z), place, bits, distances);
    vec4 inside = mix(-distances, distances, greaterThanEqual(cover, vec4(0.5))) + more.x;
    if (more.x > 0.0) return path_pack(max(cover, clamp(inside + 0.5, 0.0, 1.0)), mode, facts.y, invert);
    vec4 soft = path_soften(cover, inside, feathers);
    if (is_fine && entry.w > 0.0) {
        soft = path_refine(
            int(entry.y), int(entry.z), place, bits, facts.w, cover, soft, inside, feathers, more.z, entry.w
        );
    }
    return path_pack(soft, mode, facts.y, invert);
}

// This for outlines whose distance changes evenly.
vec4 path_covers(int bits, int across, int count, int beyond) {
    return path_find_covers(bits, across, count, beyond, false);
}

// The same where the distance changes unevenly in some tiles. Apart from the above since rasterizers on processors run
// through all that a program might do.
vec4 path_covers_fine(int bits, int across, int count, int beyond) {
    return path_find_covers(bits, across, count, beyond, true);
}

// The mask with all outlines in a pixel.
float path_cover(int bits, int across, int beyond, int columns) {
    ivec2 place = pixel + beyond * PATH_TILE, tile = place >> 4, within = place & 15;
    vec4 entries = tiles_at(path_cell(tile.y * columns + tile.x, bits));
    float covered = mask_at(pixel);
    int first = int(entries.x), last = first + int(entries.y);
    if (first == last) return covered * entries.z + entries.w;
    for (int n = first; n < last; ++n) {
        ivec2 cell = ivec2(n & ((1 << across) - 1), n >> across) * ivec2(4, 16) + ivec2(within.x >> 2, within.y);
        covered = path_combine(covered, covers_at(cell)[within.x & 3]);
    }
    return covered;
}

// The mask where there is no shape.
float path_nothing() { return 0.0; }
