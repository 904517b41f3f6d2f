#include "lib/finite.glsl"

// The part of the sides of a square that its center shows. A choice: a center of one pixel would be another one in a picture of
// another size.
const float PIXELATE_CENTER = 0.125;

// The color of one square. Squares at the right and bottom edges are cut off by the picture.
vec4 pixelate_square(vec2 side, int sampling) {
    vec2 first = vec2(pixel) * side, last = min(first + side, vec2(image_size));
    if (sampling == SAMPLING_CENTER) {
        vec2 middle = 0.5 * (first + last), reach = 0.5 * min(max(PIXELATE_CENTER * side, 1.0), last - first);
        first = middle - reach, last = middle + reach;
    }
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int y = int(first.y); y < int(ceil(last.y)); ++y)
        for (int x = int(first.x); x < int(ceil(last.x)); ++x) {
            vec2 covered = min(vec2(x, y) + 1.0, last) - max(vec2(x, y), first);
            sum += covered.x * covered.y * image_at(ivec2(x, y));
            total += covered.x * covered.y;
        }
    return finite(sum / total);
}

vec4 pixelate(vec2 side) { return squares_at(ivec2((vec2(pixel) + 0.5) / side)); }
