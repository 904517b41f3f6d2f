// Closed outlines as coverage. Each comes in spans of 8 straight segments. A picture of words says which spans matter in
// which tile: those that cross it, and for soft edges those that can be nearest to one of its pixels.
//
// Coverage is the area right of each segment, with its sign, summed over the segments of a row: exact for polygons, as
// in Levien's font-rs. What lies left of a tile is a backdrop, summed once for every row. Soft edges are a function of
// the distance to the nearest segment.

#include "lib/finite.glsl"

const int PATH_TILE = 16, PATH_SEGMENTS = 8, PATH_BITS = 24, PATH_BLOCK = 16;
const float PATH_RADIUS = 11.314;  // from the middle of a tile to its corners
const float PATH_FAR = 1e18;  // beyond all pictures; its square is still a float
const float PATH_ROUNDING = 0.01;  // pixels: floats of 32 bits are exact to this up to 131,072 pixels

// Where a span, or a channel of spans, is in its table.
ivec2 path_cell(int number) { return ivec2(number % PATH_BLOCK, number / PATH_BLOCK); }
// Where a point of a span is in the table of points.
ivec2 path_point_cell(int span, int number) {
    return ivec2(PATH_SEGMENTS * (span % PATH_BLOCK) + number, span / PATH_BLOCK);
}

// The box around a span, with room for rounding.
vec4 path_boxes() {
    int span = pixel.y * PATH_BLOCK + pixel.x;
    vec2 low = points_at(path_point_cell(int(spans_at(path_cell(span)).w), 0)).xy, high = low;
    for (int number = 0; number < PATH_SEGMENTS; ++number) {
        vec2 place = points_at(path_point_cell(span, number)).xy;
        low = min(low, place), high = max(high, place);
    }
    return vec4(low - PATH_ROUNDING, high + PATH_ROUNDING);
}

// The end of a segment of a span that starts at point `number`: after the last one follows another span.
vec4 path_end(int span, int number) {
    if (number < PATH_SEGMENTS) return points_at(path_point_cell(span, number));
    return points_at(path_point_cell(int(spans_at(path_cell(span)).w), 0));
}

// The box around the spans of a channel.
vec4 path_hulls() {
    int channel = pixel.y * PATH_BLOCK + pixel.x;
    vec4 hull = vec4(PATH_FAR, PATH_FAR, -PATH_FAR, -PATH_FAR);
    for (int b = 0; b < int(owners_at(pixel).y); ++b) {
        vec4 box = boxes_at(path_cell(channel * PATH_BITS + b));
        hull = vec4(min(hull.xy, box.xy), max(hull.zw, box.zw));
    }
    return hull;
}

// The square of the distance to a box.
float path_apart(vec4 box, vec2 place) {
    vec2 apart = max(max(box.xy - place, place - box.zw), 0.0);
    return dot(apart, apart);
}

// Tiles are counted from the left top one, which lies `beyond` tiles outside of the frame, as far as pictures go on.
ivec2 path_tile(ivec2 place, int beyond) { return (place + beyond * PATH_TILE) / PATH_TILE; }
// The left top pixel of a tile.
ivec2 path_corner(ivec2 tile, int beyond) { return (tile - beyond) * PATH_TILE; }

// --- tiles ---------------------------------------------------------------------------------------------------------

// True if a box reaches into a tile. What lies left of the picture counts for the tiles at its left edge.
bool path_touches(vec4 box, ivec2 tile, int beyond) {
    vec2 low = vec2(path_corner(tile, beyond)), high = low + float(PATH_TILE);
    if (tile.x == 0) low.x = -PATH_FAR;
    return all(lessThanEqual(box.xy, high)) && all(greaterThanEqual(box.zw, low));
}

// True if a segment of a span can lie in a tile.
bool path_crosses(int span, vec4 box, ivec2 tile, int beyond) {
    if (!path_touches(box, tile, beyond)) return false;
    vec2 start = points_at(path_point_cell(span, 0)).xy;
    for (int number = 1; number <= PATH_SEGMENTS; ++number) {
        vec2 end = path_end(span, number).xy;
        vec4 part = vec4(min(start, end) - PATH_ROUNDING, max(start, end) + PATH_ROUNDING);
        if (path_touches(part, tile, beyond)) return true;
        start = end;
    }
    return false;
}

// The spans that cross a tile: bit b of channel c of the tile's texel k stands for span 24 (4 k + c) + b.
vec4 path_words(int rows, int channels, int beyond) {
    ivec2 tile = ivec2(pixel.x / 4, pixel.y / rows);
    int first = 4 * ((pixel.y % rows) * 4 + pixel.x % 4);
    vec4 result = vec4(0.0);
    for (int c = 0; c < 4 && first + c < channels; ++c) {
        if (!path_touches(hulls_at(path_cell(first + c)), tile, beyond)) continue;
        uint bits = 0u;
        for (int b = 0; b < int(owners_at(path_cell(first + c)).y); ++b) {
            int span = (first + c) * PATH_BITS + b;
            if (path_crosses(span, boxes_at(path_cell(span)), tile, beyond)) bits |= 1u << b;
        }
        result[c] = float(bits);
    }
    return result;
}

// The spans of a channel that matter in a tile: a bit for each.
uint path_bits(ivec2 tile, int channel, int rows) {
    int texel = channel >> 2;
    return uint(words_at(ivec2(4 * tile.x + (texel & 3), rows * tile.y + (texel >> 2)))[channel & 3]);
}

// The words of a shape in a tile that are not 0: a bit for each, 96 in a texel.
vec4 path_digest(int rows, int groups, int count) {
    int column = pixel.x / groups;
    ivec2 tile = ivec2(column / count, pixel.y);
    vec4 shape = shapes_at(ivec2(0, column % count)), result = vec4(0.0);
    int channel = 4 * PATH_BITS * (pixel.x % groups);
    for (int c = 0; c < 4; ++c) {
        uint bits = 0u;
        for (int b = 0; b < PATH_BITS && channel < int(shape.y); ++b, ++channel)
            if (path_bits(tile, int(shape.x) + channel, rows) != 0u) bits |= 1u << b;
        result[c] = float(bits);
    }
    return result;
}

// The words that are not 0 of 24 channels of a shape; `column` is that of the digest where the shape starts.
uint path_used(int column, int row, int part) { return uint(digest_at(ivec2(column + (part >> 2), row))[part & 3]); }

// --- areas ---------------------------------------------------------------------------------------------------------

// The part of a segment in a row: how far down it goes, and where it starts and ends.
struct PathPart {
    float rise, start, end;
};

// The part of a segment from a to b in a row.
PathPart path_part(vec2 a, vec2 b, float row) {
    float low = clamp(a.y, row, row + 1.0), high = clamp(b.y, row, row + 1.0);
    float slope = a.y == b.y ? 0.0 : (b.x - a.x) / (b.y - a.y);
    float least = min(a.x, b.x), most = max(a.x, b.x);
    float start = clamp(a.x + (low - a.y) * slope, least, most), end = clamp(a.x + (high - a.y) * slope, least, most);
    return PathPart(high - low, start, end);
}

// How much of a part lies left of a place.
float path_share(PathPart part, float limit) {
    float low = min(part.start, part.end), high = max(part.start, part.end);
    return high > low ? clamp((limit - low) / (high - low), 0.0, 1.0) : float(low < limit);
}

// Where a tile starts; the first one holds what lies left of the picture.
float path_left(int tile, int beyond) { return tile == 0 ? -PATH_FAR : float((tile - beyond) * PATH_TILE); }

// How far down the segments of a span go between two places, in each of four rows.
vec4 path_descent(int span, float top, float left, float right) {
    vec4 box = boxes_at(path_cell(span)), sum = vec4(0.0);
    if (box.w < top || box.y > top + 4.0) return sum;
    vec2 start = points_at(path_point_cell(span, 0)).xy;
    for (int number = 1; number <= PATH_SEGMENTS; ++number) {
        vec2 end = path_end(span, number).xy;
        for (int row = 0; row < 4; ++row) {
            PathPart part = path_part(start, end, top + float(row));
            if (part.rise != 0.0) sum[row] += part.rise * (path_share(part, right) - path_share(part, left));
        }
        start = end;
    }
    return sum;
}

// How far down the segments of a shape go within a tile, in each of four rows.
vec4 path_crossings(int rows, int groups, int count, int beyond) {
    ivec2 tile = ivec2(pixel.x / count, 4 * pixel.y / PATH_TILE);
    vec4 shape = shapes_at(ivec2(0, pixel.x % count)), sum = vec4(0.0);
    float left = path_left(tile.x, beyond), right = path_left(tile.x + 1, beyond);
    float top = float(4 * pixel.y - beyond * PATH_TILE);
    int column = (tile.x * count + pixel.x % count) * groups;
    for (int part = 0; part < (int(shape.y) + PATH_BITS - 1) / PATH_BITS; ++part)
        for (uint used = path_used(column, tile.y, part); used != 0u; used &= used - 1u) {
            int channel = int(shape.x) + part * PATH_BITS + findLSB(used);
            for (uint bits = path_bits(tile, channel, rows); bits != 0u; bits &= bits - 1u)
                sum += path_descent(channel * PATH_BITS + findLSB(bits), top, left, right);
        }
    return sum;
}

// The sum of what lies left of a tile, in each of four rows.
vec4 path_backdrop(int count) {
    vec4 sum = vec4(0.0);
    for (int x = pixel.x - count; x >= 0; x -= count) sum += steps_at(ivec2(x, pixel.y));
    return sum;
}

// --- pixels --------------------------------------------------------------------------------------------------------

// The area in a pixel that lies right of a span, without what the backdrop of the tile has. The number of segments is
// no constant here, so that the loop is not unrolled: llvmpipe runs a body once even where no pixel needs it.
float path_area(int span, vec2 corner, float left, int segments) {
    vec2 start = points_at(path_point_cell(span, 0)).xy;
    float sum = 0.0;
    for (int number = 1; number <= segments; ++number) {
        vec2 end = path_end(span, number).xy, from = start;
        start = end;
        if (max(from.y, end.y) <= corner.y || min(from.y, end.y) >= corner.y + 1.0) continue;
        PathPart part = path_part(from, end, corner.y);
        float before = path_share(part, corner.x), within = path_share(part, corner.x + 1.0) - before;
        float middle = 0.5 * (clamp(part.start - corner.x, 0.0, 1.0) + clamp(part.end - corner.x, 0.0, 1.0));
        sum += part.rise * (before + within * (1.0 - middle) - path_share(part, left));
    }
    return sum;
}

const int PATH_UNION = 0, PATH_SUBTRACT = 1, PATH_INTERSECT = 2, PATH_MAX = 3, PATH_MIN = 4, PATH_DIFFERENCE = 5;

// A mask with one more shape; the last mode is their sum.
float path_combine(float below, float cover, int mode, float opacity, bool invert) {
    if (invert) cover = 1.0 - cover;
    float amount = cover * opacity, kept = 1.0 - opacity * (1.0 - cover);
    if (mode == PATH_UNION) return below + amount * (1.0 - below);
    if (mode == PATH_SUBTRACT) return below * (1.0 - amount);
    if (mode == PATH_INTERSECT) return below * kept;
    if (mode == PATH_MAX) return max(below, amount);
    if (mode == PATH_MIN) return min(below, kept);
    if (mode == PATH_DIFFERENCE) return abs(below - amount);
    return min(below + amount, 1.0);
}

// A mask with one more shape, by its mode and opacity in the table of shapes.
float path_add(float below, float cover, int number) {
    vec4 facts = shapes_at(ivec2(1, number));
    return path_combine(below, cover, int(shapes_at(ivec2(0, number)).w), facts.x, facts.y > 0.5);
}

// The coverage of a shape in a pixel.
float path_shape(int number, ivec2 tile, int rows, int groups, int count, int segments, int beyond) {
    vec2 corner = vec2(pixel);
    float left = path_left(tile.x, beyond);
    vec4 shape = shapes_at(ivec2(0, number));
    int column = tile.x * count + number;
    int row = pixel.y + beyond * PATH_TILE;
    float sum = backdrop_at(ivec2(column, row >> 2))[row & 3];
    for (int part = 0; part < (int(shape.y) + PATH_BITS - 1) / PATH_BITS; ++part)
        for (uint used = path_used(column * groups, tile.y, part); used != 0u; used &= used - 1u) {
            int channel = int(shape.x) + part * PATH_BITS + findLSB(used);
            for (uint bits = path_bits(tile, channel, rows); bits != 0u; bits &= bits - 1u) {
                int span = channel * PATH_BITS + findLSB(bits);
                vec4 box = boxes_at(path_cell(span));
                if (box.y < corner.y + 1.0 && box.w > corner.y) sum += path_area(span, corner, left, segments);
            }
        }
    return min(abs(sum), 1.0);
}

// True if a mask of 0..1 becomes itself times a number, plus another one. Modes after intersect do so only with a shape
// that counts wholly or not at all.
bool path_is_linear(float cover, int number) {
    float opacity = shapes_at(ivec2(1, number)).x;
    return int(shapes_at(ivec2(0, number)).w) <= PATH_INTERSECT || opacity == 0.0 ||
           (opacity == 1.0 && (cover == 0.0 || cover == 1.0));
}

// What all shapes do in a tile that none of their spans matters in: the mask below times x, plus y. Else z is 1.
vec4 path_level(int groups, int count) {
    vec2 ends = vec2(0.0, 1.0);  // what the shapes make of a mask of 0 and of 1
    for (int number = 0; number < count; ++number) {
        int column = pixel.x * count + number;
        for (int group = 0; group < groups; ++group)
            if (digest_at(ivec2(column * groups + group, pixel.y)) != vec4(0.0)) return vec4(0.0, 0.0, 1.0, 0.0);
        float cover = min(abs(backdrop_at(ivec2(column, pixel.y * PATH_TILE / 4)).x), 1.0);
        if (!path_is_linear(cover, number)) return vec4(0.0, 0.0, 1.0, 0.0);
        ends = vec2(path_add(ends.x, cover, number), path_add(ends.y, cover, number));
    }
    return vec4(ends.y - ends.x, ends.x, 0.0, 0.0);
}

// The mask with the coverage of all shapes in a pixel; tiles that no edge crosses have one level.
float path_cover(int rows, int groups, int count, int segments, int beyond) {
    ivec2 tile = path_tile(pixel, beyond);
    float covered = mask_at(pixel);
    vec4 level = levels_at(tile);
    if (level.z == 0.0) return covered * level.x + level.y;
    for (int number = 0; number < count; ++number)
        covered = path_add(covered, path_shape(number, tile, rows, groups, count, segments, beyond), number);
    return covered;
}

// The mask where there is no shape.
float path_nothing() { return 0.0; }

// --- soft edges ----------------------------------------------------------------------------------------------------

// Where a texel of a chord is in the table of chords.
ivec2 path_chord_cell(int chord, int texel) { return ivec2(2 * (chord % PATH_BLOCK) + texel, chord / PATH_BLOCK); }

// The square of the distance to a chord, and where along it the nearest place is.
vec2 path_chord(vec4 chord, vec2 place) {
    vec2 edge = chord.zw - chord.xy, to = place - chord.xy;
    float t = clamp(dot(to, edge) / max(dot(edge, edge), 1e-12), 0.0, 1.0);
    vec2 away = to - t * edge;
    return vec2(dot(away, away), t);
}

// The box around the chords of a channel.
vec4 path_chord_hulls(int chord_count) {
    int first = (pixel.y * PATH_BLOCK + pixel.x) * PATH_BITS;
    vec4 hull = vec4(PATH_FAR, PATH_FAR, -PATH_FAR, -PATH_FAR);
    for (int number = first; number < min(first + PATH_BITS, chord_count); ++number) {
        vec4 chord = chords_at(path_chord_cell(number, 0));
        hull = vec4(min(hull.xy, min(chord.xy, chord.zw)), max(hull.zw, max(chord.xy, chord.zw)));
    }
    return hull;
}

// The middle of a tile, in pixels.
vec2 path_middle(ivec2 tile, int beyond) { return vec2(path_corner(tile, beyond)) + 0.5 * float(PATH_TILE); }

// The distance from the middle of a tile to the nearest chord.
float path_nearest(int chord_count, int channels, int beyond) {
    vec2 middle = path_middle(pixel, beyond);
    float square = PATH_FAR;
    for (int channel = 0; channel < channels; ++channel) {
        if (path_apart(hulls_at(path_cell(channel)), middle) >= square) continue;
        int first = channel * PATH_BITS;
        for (int number = first; number < min(first + PATH_BITS, chord_count); ++number)
            square = min(square, path_chord(chords_at(path_chord_cell(number, 0)), middle).x);
    }
    return sqrt(square);
}

// The chords that can be nearest to a pixel of a tile: no farther from its middle than the nearest one and twice the
// way to its corners.
vec4 path_chord_words(int rows, int channels, int chord_count, float reach, int beyond) {
    ivec2 tile = ivec2(pixel.x / 4, pixel.y / rows);
    int first = 4 * ((pixel.y % rows) * 4 + pixel.x % 4);
    vec2 middle = path_middle(tile, beyond);
    float limit = min(nearest_at(tile) + 2.0 * PATH_RADIUS, reach + PATH_RADIUS);
    vec4 result = vec4(0.0);
    for (int c = 0; c < 4 && first + c < channels; ++c) {
        if (path_apart(hulls_at(path_cell(first + c)), middle) > limit * limit) continue;
        uint bits = 0u;
        for (int b = 0, number = (first + c) * PATH_BITS; b < PATH_BITS && number < chord_count; ++b, ++number)
            if (path_chord(chords_at(path_chord_cell(number, 0)), middle).x <= limit * limit) bits |= 1u << b;
        result[c] = float(bits);
    }
    return result;
}

// The distance to the nearest chord, as far as it is within reach, and the feather there.
vec2 path_distance(int rows, int groups, int parts, float reach, int beyond) {
    ivec2 tile = path_tile(pixel, beyond);
    vec2 place = vec2(pixel) + 0.5;
    vec3 nearest = vec3(reach * reach, -1.0, 0.0);
    for (int part = 0; part < parts; ++part)
        for (uint used = path_used(tile.x * groups, tile.y, part); used != 0u; used &= used - 1u) {
            int channel = part * PATH_BITS + findLSB(used);
            for (uint bits = path_bits(tile, channel, rows); bits != 0u; bits &= bits - 1u) {
                int number = channel * PATH_BITS + findLSB(bits);
                vec2 chord = path_chord(chords_at(path_chord_cell(number, 0)), place);
                if (chord.x < nearest.x) nearest = vec3(chord.x, number, chord.y);
            }
        }
    if (nearest.y < 0.0) return vec2(reach, 0.0);
    vec4 feathers = chords_at(path_chord_cell(int(nearest.y), 1));
    return vec2(sqrt(nearest.x), mix(feathers.x, feathers.y, nearest.z));
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
