// Closed outlines as coverage. Tables say what matters in each tile: `outline_tables.py` makes them.
//
// Coverage is the area right of each segment, with its sign, summed over the segments of a row: exact for polygons, as
// in Levien's font-rs. What lies left of a tile is a number for each row. Soft edges are a function of the distance to
// the nearest chord; where points have feathers, to that which is nearest for its feather. So the edge has no steps where
// another part of the outline becomes the nearest one.

#include "lib/finite.glsl"

const int PATH_TILE = 16, PATH_STRIP = 4, PATH_ENTRY = 10;
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

// The same for chords whose feathers differ: the least distance for the feather there, which is `feather` more than that
// of the chord. No edge counts as narrower than a pixel. Both the place and the feather change evenly on a chord, so the
// square of the quotient has one minimum.
void path_nearest_wide(
    int first, int count, vec2 place, int bits, float feather, out vec4 distances, out vec4 feathers
) {
    vec4 least = vec4(1e30), across = place.x + vec4(0.0, 1.0, 2.0, 3.0);
    distances = vec4(1e15);
    feathers = vec4(feather);
    for (int n = first; n < first + count; ++n) {
        vec4 four = nearest_at(path_cell(n, bits));
        for (int k = 0; k < 4; ++k) {
            vec4 ends = chords_at(path_cell(2 * int(four[k]), bits));
            vec2 more = chords_at(path_cell(2 * int(four[k]) + 1, bits)).xy + feather, wide = max(more, 1.0);
            vec2 edge = ends.zw - ends.xy;
            float y = place.y - ends.y, growth = wide.y - wide.x;
            vec4 x = across - ends.x, run = x * edge.x + y * edge.y;
            vec4 slope = dot(edge, edge) * wide.x + growth * run;
            vec4 t = (growth * (x * x + y * y) + run * wide.x) / max(slope, 1e-12);
            t = mix(vec4(growth > 0.0 ? 1.0 : 0.0), clamp(t, 0.0, 1.0), greaterThan(slope, vec4(0.0)));
            x -= t * edge.x;
            vec4 away = y - t * edge.y, width = wide.x + t * growth, square = x * x + away * away;
            vec4 relative = square / (width * width);
            bvec4 nearer = lessThan(relative, least);
            least = mix(least, relative, nearer);
            distances = mix(distances, sqrt(square), nearer);
            feathers = mix(feathers, mix(vec4(more.x), vec4(more.y), t), nearer);
        }
    }
}

// The integral of the soft edge 3 t^2 - 2 t^3.
float path_integral(float t) {
    float u = clamp(t, 0.0, 1.0);
    return u * u * u * (1.0 - 0.5 * u) + max(t - 1.0, 0.0);
}

// The coverage of a soft edge at a distance in pixels, above 0 inside: its mean over a pixel. Below one pixel of
// feather the exact coverage takes over.
float path_soften(float cover, float inside, float feather) {
    if (feather <= 0.0) return cover;
    float t = 0.5 + inside / feather, step = 0.5 / feather;
    float soft = (path_integral(t + step) - path_integral(t - step)) * feather;
    return mix(cover, soft, min(feather, 1.0));
}

// What an outline does to four pixels beside each other, packed: four texels by sixteen for each entry of a tile, 2^across
// of which lie side by side.
vec4 path_covers(int bits, int across, int count, int beyond) {
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
    vec2 more = shapes_at(path_cell(2 * int(entry.x) + 1, bits)).xy;  // growth, and whether points have feathers
    vec2 place = tile * float(PATH_TILE) + vec2(within) + 0.5;
    vec4 distances, feathers = vec4(facts.w);
    if (more.y > 0.0) path_nearest_wide(int(entry.y), int(entry.z), place, bits, facts.w, distances, feathers);
    else path_nearest(int(entry.y), int(entry.z), place, bits, distances);
    vec4 inside = mix(-distances, distances, greaterThanEqual(cover, vec4(0.5))) + more.x;
    if (more.x > 0.0) return path_pack(max(cover, clamp(inside + 0.5, 0.0, 1.0)), mode, facts.y, invert);
    for (int n = 0; n < 4; ++n) cover[n] = path_soften(cover[n], inside[n], feathers[n]);
    return path_pack(cover, mode, facts.y, invert);
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
