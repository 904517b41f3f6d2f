// The picture `image` at several sizes in one, for samples that each stand for an area: a lamp of a few pixels is then
// met by many dim samples instead of a few that are too bright (filtered importance sampling, Krivanek and Colbert
// 2008). The whole picture is at the left, its halves, quarters and so on are below each other at its right.
#include "lib/finite.glsl"

const int PREFILTERED_LEVELS = 6;  // the smallest pixels are 64 x 64 of the picture: 1 / 8 of 540 rows

// The number of pixels of a level.
ivec2 prefiltered_cells(ivec2 size, int level) { return (size + (1 << level) - 1) >> level; }

// The first pixel of a level.
ivec2 prefiltered_corner(ivec2 size, int level) {
    ivec2 corner = ivec2(level > 0 ? size.x : 0, 0);
    for (int i = 1; i < level; ++i) corner.y += prefiltered_cells(size, i).y;
    return corner;
}

// A pixel at half the size: the mean of what it covers.
vec4 prefiltered_half() {
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 at = 2 * pixel + ivec2(i & 1, i >> 1);
        if (any(greaterThanEqual(at, image_size))) continue;
        sum += finite(image_at(at));
        total += 1.0;
    }
    return sum / total;
}

// All levels in one picture, from the picture and what prefiltered_half() made of it again and again.
vec4 prefiltered_levels() {
    ivec2 size = image_size;
    if (pixel.x < size.x) return pixel.y < size.y ? finite(image_at(pixel)) : vec4(0.0);
    int level = 1;
    while (level < PREFILTERED_LEVELS && pixel.y >= prefiltered_corner(size, level + 1).y) ++level;
    ivec2 at = pixel - prefiltered_corner(size, level);
    if (any(greaterThanEqual(at, prefiltered_cells(size, level)))) return vec4(0.0);
    if (level == 1) return half1_at(at);
    if (level == 2) return half2_at(at);
    if (level == 3) return half3_at(at);
    if (level == 4) return half4_at(at);
    return level == 5 ? half5_at(at) : half6_at(at);
}
