#include "lib/finite.glsl"

// The picture at a place: between two pixels the mean of both, by how near they are.
vec4 pixelate_between(vec2 place) {
    ivec2 near = ivec2(floor(place - 0.5));
    vec2 part = place - 0.5 - vec2(near);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        ivec2 off = ivec2(i & 1, i >> 1);
        float weight = (off.x > 0 ? part.x : 1.0 - part.x) * (off.y > 0 ? part.y : 1.0 - part.y);
        if (weight > 0.0) sum += weight * image_at(near + off);
    }
    return finite(sum);
}

// The color of one square. Squares at the right and bottom edges are cut off by the picture.
vec4 pixelate_square(vec2 side, int sampling) {
    vec2 first = vec2(pixel) * side, last = min(first + side, vec2(image_size));
    if (sampling == SAMPLING_CENTER) return pixelate_between(0.5 * (first + last));
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
