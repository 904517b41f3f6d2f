// Strokes of a brush over a picture. A stroke covers what any disc of its brush covers on the way, so its weight at a
// place is that of the disc whose rim is relatively farthest away. A picture of words says which segments of the way
// can matter in which tile, and a digest which words are not 0.

#include "lib/alpha.glsl"
#include "lib/blending.glsl"
#include "lib/finite.glsl"

const int PAINT_TILE = 16, PAINT_BITS = 24, PAINT_BLOCK = 16;
const float PAINT_RADIUS = 12.0;  // from the middle of a tile beyond its corners, with room for rims
const int PAINT_BRUSH = 0, PAINT_ERASE = 1, PAINT_CLONE = 2, PAINT_REVEAL = 3;

ivec2 paint_cell(int number, int texel) { return ivec2(2 * (number % PAINT_BLOCK) + texel, number / PAINT_BLOCK); }

// --- tiles ---------------------------------------------------------------------------------------------------------

// True if a segment of a way comes near the middle of a tile.
bool paint_touches(int segment, vec2 middle) {
    vec4 start = segments_at(paint_cell(segment, 0)), end = segments_at(paint_cell(segment, 1));
    vec2 way = end.xy - start.xy, rest = middle - start.xy;
    float t = clamp(dot(rest, way) / max(dot(way, way), 1e-12), 0.0, 1.0);
    return distance(rest, t * way) <= max(start.z, end.z) + PAINT_RADIUS;
}

// The segments that come near a tile: bit b of channel c of the tile's texel k stands for segment 24 (4 k + c) + b.
vec4 paint_words(vec2 origin, int rows, int channels) {
    ivec2 tile = ivec2(pixel.x / 4, pixel.y / rows);
    vec2 low = origin + vec2(tile * PAINT_TILE), middle = low + 0.5 * float(PAINT_TILE);
    int first = 4 * ((pixel.y % rows) * 4 + pixel.x % 4);
    vec4 result = vec4(0.0);
    for (int c = 0; c < 4 && first + c < channels; ++c) {
        vec4 box = owners_at(paint_cell(first + c, 1));
        if (any(greaterThan(box.xy, low + float(PAINT_TILE))) || any(lessThan(box.zw, low))) continue;
        uint bits = 0u;
        for (int b = 0; b < int(owners_at(paint_cell(first + c, 0)).y); ++b)
            if (paint_touches((first + c) * PAINT_BITS + b, middle)) bits |= 1u << b;
        result[c] = float(bits);
    }
    return result;
}

ivec2 paint_word(ivec2 tile, int texel, int rows) {
    return ivec2(4 * tile.x + (texel & 3), rows * tile.y + (texel >> 2));
}

// The texels of words of a tile that are not 0: a bit for each, 24 in a channel.
vec4 paint_digest(int rows) {
    vec4 result = vec4(0.0);
    int texel = 0;
    for (int c = 0; c < 4; ++c) {
        uint bits = 0u;
        for (int b = 0; b < PAINT_BITS && texel < 4 * rows; ++b, ++texel)
            if (words_at(paint_word(pixel, texel, rows)) != vec4(0.0)) bits |= 1u << b;
        result[c] = float(bits);
    }
    return result;
}

// --- coverage ------------------------------------------------------------------------------------------------------

// The disc of a segment in which a place is nearest to the middle, relative to its radius: from its middle to the
// place, and the radius. Both the middle and the radius change evenly on the way, so the square of the quotient has one
// minimum.
vec3 paint_disc(int segment, vec2 place) {
    vec4 start = segments_at(paint_cell(segment, 0)), end = segments_at(paint_cell(segment, 1));
    vec2 way = end.xy - start.xy, rest = place - start.xy;
    float growth = end.z - start.z, along = dot(rest, way);
    float slope = dot(way, way) * start.z + growth * along;
    float t = growth > 0.0 ? 1.0 : 0.0;
    if (slope > 0.0) t = clamp((growth * dot(rest, rest) + along * start.z) / slope, 0.0, 1.0);
    return vec3(rest - t * way, max(start.z + t * growth, 1e-6));
}

// How far a place is from the middle of a disc, 1 at its rim.
float paint_apart(vec3 disc) { return length(disc.xy) / disc.z; }

// The integral of the weight of a brush up to a distance in pixels inside its rim; it rises over `fall` pixels.
float paint_integral(float inside, float fall) {
    if (inside >= fall) return inside - 0.5 * fall;
    float t = max(inside, 0.0) / max(fall, 1e-6);
    return fall * t * t * t * (1.0 - 0.5 * t);
}

// The mean weight in a square of this width: near a rim it changes along one direction only. The area of a square
// beside a line is the integral of the integral of a step.
float paint_weight(vec3 disc, float hardness, float width) {
    float away = length(disc.xy), inside = disc.z - away, fall = (1.0 - hardness) * disc.z;
    if (fall > 2.0 * width)
        return (paint_integral(inside + 0.5 * width, fall) - paint_integral(inside - 0.5 * width, fall)) / width;
    vec2 across = max(abs(disc.xy) / max(away, 1e-6), 0.02) * 0.5 * width;
    float sum = across.x + across.y, apart = across.x - across.y;
    vec4 ends = max(inside - 0.5 * fall + vec4(sum, apart, -apart, -sum), 0.0);
    ends *= ends;
    return clamp((ends.x - ends.y - ends.z + ends.w) / (8.0 * across.x * across.y), 0.0, 1.0);
}

// True if another part of the way is as near as that of a disc, but in another direction: the weight has a ridge there.
bool paint_has_ridge(ivec2 at, vec3 disc, ivec4 segments) {
    for (int next = 1; next < 4 && segments[next] >= 0; ++next) {
        vec3 other = paint_disc(segments[next], vec2(at) + 0.5);
        bool is_near = (paint_apart(other) - paint_apart(disc)) * disc.z < 2.0;
        if (is_near && dot(other.xy, disc.xy) < 0.98 * length(other.xy) * length(disc.xy)) return true;
    }
    return false;
}

// How much of a pixel a stroke covers, by the segments that matter most there: near rims the mean of smaller pixels,
// elsewhere the weight at the middle.
float paint_pixel(ivec2 at, vec3 disc, ivec4 segments, float hardness) {
    float inside = disc.z - length(disc.xy), fall = (1.0 - hardness) * disc.z;
    if (inside < -0.75) return 0.0;
    if (inside > fall + 0.75) return 1.0;
    if (fall > 24.0 || (fall > 10.0 && !paint_has_ridge(at, disc, segments))) return paint_weight(disc, hardness, 1.0);
    int parts = fall > 2.0 ? 4 : disc.z > 1.0 ? 8 : 16;
    float sum = 0.0, width = 1.0 / float(parts);
    for (int part = 0; part < parts * parts; ++part) {
        vec2 place = vec2(at) + width * (vec2(part % parts, part / parts) + 0.5);
        vec3 nearest = paint_disc(segments.x, place);
        for (int next = 1; next < 4 && segments[next] >= 0; ++next) {
            vec3 other = paint_disc(segments[next], place);
            if (paint_apart(other) < paint_apart(nearest)) nearest = other;
        }
        sum += paint_weight(nearest, hardness, width);
    }
    return clamp(sum * width * width, 0.0, 1.0);
}

// --- the strokes of a pixel ----------------------------------------------------------------------------------------

// A way through the segments near a pixel, stroke by stroke.
struct PaintWalk {
    ivec2 tile;
    vec4 digest;
    int part, texel, next, channel, stroke;
    uint used, bits;
    vec4 word;
};

// Go on to the next channel that has segments near this tile; `stroke` is -1 after the last one.
void paint_advance(inout PaintWalk walk, int rows) {
    walk.stroke = -1;
    while (true) {
        for (; walk.next < 4; ++walk.next)
            if (walk.word[walk.next] != 0.0) {
                walk.channel = 4 * walk.texel + walk.next;
                walk.bits = uint(walk.word[walk.next]);
                walk.stroke = int(owners_at(paint_cell(walk.channel, 0)).x);
                ++walk.next;
                return;
            }
        while (walk.used == 0u) {
            if (++walk.part == 4) return;
            walk.used = uint(walk.digest[walk.part]);
        }
        walk.texel = PAINT_BITS * walk.part + findLSB(walk.used);
        walk.used &= walk.used - 1u;
        walk.word = words_at(paint_word(walk.tile, walk.texel, rows));
        walk.next = 0;
    }
}

PaintWalk paint_begin(int rows) {
    ivec2 tile = pixel / PAINT_TILE;
    PaintWalk walk = PaintWalk(tile, digest_at(tile), -1, 0, 4, 0, -1, 0u, 0u, vec4(0.0));
    if (walk.digest != vec4(0.0)) paint_advance(walk, rows);
    return walk;
}

// How much of this pixel the next stroke covers.
float paint_cover(inout PaintWalk walk, ivec2 at, int rows) {
    int stroke = walk.stroke;
    vec4 order = vec4(1e9);  // how far the four nearest discs are
    ivec4 segments = ivec4(-1);
    vec3 nearest = vec3(1e9, 0.0, 1.0);
    while (walk.stroke == stroke) {
        for (uint bits = walk.bits; bits != 0u; bits &= bits - 1u) {
            int segment = walk.channel * PAINT_BITS + findLSB(bits);
            vec3 disc = paint_disc(segment, vec2(at) + 0.5);
            float apart = paint_apart(disc);
            if (apart < order.x) {
                order = vec4(apart, order.xyz), segments = ivec4(segment, segments.xyz);
                nearest = disc;
            } else if (apart < order.y) {
                order = vec4(order.x, apart, order.yz), segments = ivec4(segments.x, segment, segments.yz);
            } else if (apart < order.z) {
                order = vec4(order.xy, apart, order.z), segments = ivec4(segments.xy, segment, segments.z);
            } else if (apart < order.w) {
                order.w = apart, segments.w = segment;
            }
        }
        paint_advance(walk, rows);
    }
    return paint_pixel(at, nearest, segments, strokes_at(ivec2(0, stroke)).w);
}

// --- what strokes do -----------------------------------------------------------------------------------------------

float paint_channel(int blend, float b, float a) {
    if (blend == 2) return b * a;
    if (blend == 3) return blend_screen(b, a);
    if (blend == 4) return blend_hard_light(a, b);
    if (blend == 5) return blend_soft_light(b, a);
    if (blend == 6) return blend_color_dodge(b, a);
    if (blend == 7) return blend_color_burn(b, a);
    if (blend == 8) return min(b, a);
    if (blend == 9) return max(b, a);
    return blend == 10 ? abs(b - a) : b - a;
}

// A picture below with a color over it, as `merge` blends them.
vec4 paint_brush(vec4 below, vec3 color, int blend, float amount) {
    if (blend == 0) return mix(below, vec4(color, 1.0), amount);
    if (blend == 1) return vec4(below.rgb + color * amount, min(below.a + amount, 1.0));
    vec3 b = max(straight(below).rgb, 0.0), a = max(color, 0.0);
    vec3 both = vec3(paint_channel(blend, b.r, a.r), paint_channel(blend, b.g, a.g), paint_channel(blend, b.b, a.b));
    vec3 rgb = color * amount * (1.0 - below.a) + below.rgb * (1.0 - amount) + amount * below.a * both;
    return vec4(rgb, amount + below.a * (1.0 - amount));
}

vec4 paint_stroke(vec4 below, ivec2 at, int number, float cover) {
    vec4 facts = strokes_at(ivec2(0, number)), color = strokes_at(ivec2(1, number));
    int tool = int(facts.x);
    float amount = cover * facts.z;
    if (tool == PAINT_BRUSH) return paint_brush(below, color.rgb, int(facts.y), amount);
    if (tool == PAINT_ERASE) return mix(below, image_has(at) ? finite(image_at(at)) : vec4(0.0), amount);
    if (tool == PAINT_CLONE || tool == PAINT_REVEAL) {
        vec2 offset = strokes_at(ivec2(2, number)).xy, place = vec2(at) + 0.5 + offset;
        bool is_whole = offset == floor(offset);  // no other pixel has a part in it then, not even an infinite one
        ivec2 from = at + ivec2(offset);
        if (color.w > 0.5) return mix(below, finite(is_whole ? other_at(from) : other_near(place)), amount);
        return mix(below, finite(is_whole ? base_at(from) : base_near(place)), amount);
    }
    return mix(below, finite(blurred_at(at)), amount);
}

// A patch of the picture with strokes.
vec4 paint_run(vec2 origin, int rows) {
    ivec2 at = pixel + ivec2(origin);
    vec4 color = base_has(at) ? finite(base_at(at)) : vec4(0.0);
    PaintWalk walk = paint_begin(rows);
    while (walk.stroke >= 0) {
        int number = walk.stroke;
        float cover = paint_cover(walk, at, rows);
        if (cover > 0.0) color = paint_stroke(color, at, number, cover);
    }
    return color;
}

// A patch of the mask of all strokes.
float paint_mask(vec2 origin, int rows) {
    ivec2 at = pixel + ivec2(origin);
    float covered = cover_at(at);
    PaintWalk walk = paint_begin(rows);
    while (walk.stroke >= 0) {
        vec4 facts = strokes_at(ivec2(0, walk.stroke));
        float amount = paint_cover(walk, at, rows) * facts.z;
        covered = mix(covered, int(facts.x) == PAINT_ERASE ? 0.0 : 1.0, amount);
    }
    return covered;
}

// Where in the picture the color of a place comes from that was dragged along: it is taken back through all stamps, the
// last one first.
vec2 paint_origin(vec2 place, int count, float hardness, float strength) {
    for (int first = (count - 1) / PAINT_BLOCK * PAINT_BLOCK; first >= 0; first -= PAINT_BLOCK) {
        vec4 hull = hulls_at(ivec2(first / PAINT_BLOCK % PAINT_BLOCK, first / PAINT_BLOCK / PAINT_BLOCK));
        if (any(lessThan(place, hull.xy)) || any(greaterThan(place, hull.zw))) continue;
        for (int stamp = min(first + PAINT_BLOCK, count) - 1; stamp >= first; --stamp) {
            vec4 disc = stamps_at(paint_cell(stamp, 0));
            float inside = disc.z - distance(place, disc.xy), fall = max((1.0 - hardness) * disc.z, 1e-6);
            float t = clamp(inside / fall, 0.0, 1.0);
            place -= strength * t * t * (3.0 - 2.0 * t) * stamps_at(paint_cell(stamp, 1)).xy;
        }
    }
    return place;
}

// A patch of the picture with what is under a brush dragged along: at the rims of what was dragged the mean of four
// places in each pixel, elsewhere one, which keeps the picture sharp.
vec4 paint_smear(int count, vec2 origin, float hardness, float strength) {
    ivec2 at = pixel + ivec2(origin);
    vec2 middle = vec2(at) + 0.5, first = vec2(0.0);
    vec4 sum = vec4(0.0);
    float spread = 0.0;
    for (int part = 0; part < 4; ++part) {
        vec2 place = vec2(at) + 0.25 + 0.5 * vec2(part & 1, part >> 1);
        vec2 away = paint_origin(place, count, hardness, strength) - place;
        if (part == 0) first = away;
        spread = max(spread, distance(away, first));
        sum += finite(base_near(away == vec2(0.0) ? middle : place + away));
    }
    if (spread == 0.0 && first == vec2(0.0)) return finite(base_at(at));
    return spread < 0.25 ? finite(base_near(paint_origin(middle, count, hardness, strength))) : 0.25 * sum;
}

// The picture with a patch in its place.
vec4 paint_place(vec2 origin) {
    ivec2 at = pixel - ivec2(origin);
    bool is_inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, patch_size));
    if (is_inside) return patch_at(at);
    return base_has(pixel) ? finite(base_at(pixel)) : vec4(0.0);
}

float paint_place_mask(vec2 origin) {
    ivec2 at = pixel - ivec2(origin);
    bool is_inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, patch_size));
    return is_inside ? patch_at(at) : cover_at(pixel);
}

vec4 paint_unchanged(vec4 image) { return finite(image); }
float paint_nothing() { return 0.0; }
