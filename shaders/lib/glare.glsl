// Glare that is spread at a fraction of the picture's size: tents hand out light to fewer pixels and back, so that its
// center and its sum stay wherever it is. The smaller picture has an apron of one pixel.

#include "lib/finite.glsl"

const float GLARE_BRIGHTEST = 65504.0;  // more would overflow in sums

// Light to spread. Alpha becomes 1: spread with it, it says how much of the glare comes from within the picture.
vec4 glare_light(vec4 image) {
    return vec4(clamp(finite(image).rgb, -GLARE_BRIGHTEST, GLARE_BRIGHTEST), 1.0);
}

// Where the light that a smaller pixel collects begins, 2 * `factor` pixels along each axis, and its part of one of them.
ivec2 glare_first(int factor) { return (pixel - 1) * factor - factor / 2; }
float glare_share(ivec2 p, int factor) {
    vec2 share = 1.0 - abs((vec2(p) + 0.5) / float(factor) - 1.0);
    return share.x * share.y;
}

// The light of a smaller picture of `image`: sums, not averages. Outside lies black.
vec4 glare_shrunk(int factor) {
    ivec2 first = glare_first(factor);
    vec4 sum = vec4(0.0);
    for (int y = 0; y < 2 * factor; ++y)
        for (int x = 0; x < 2 * factor; ++x) sum += glare_share(ivec2(x, y), factor) * image_at(first + ivec2(x, y));
    return sum;
}

// Where a pixel lies in the smaller picture.
vec2 glare_grown(int factor) { return (vec2(pixel) + 0.5) / float(factor) + 1.0; }
