// Glare at a fraction of the picture's size. Tent filters distribute light to fewer pixels and back, which keeps its
// center and its sum. The smaller picture has a border of one more pixel on each side.

#include "lib/finite.glsl"

const float GLARE_BRIGHTEST = 65504.0;  // the largest half float: more could overflow in sums

// The light to spread. Its alpha is 1: after spreading, alpha is the part of the glare that comes from within the
// picture.
vec4 glare_light(vec4 image) {
    return vec4(clamp(finite(image).rgb, -GLARE_BRIGHTEST, GLARE_BRIGHTEST), 1.0);
}

// The first of the 2 * `factor` pixels along each axis from which a smaller pixel collects light.
ivec2 glare_first(int factor) { return (pixel - 1) * factor - factor / 2; }
// The share of a smaller pixel in the light of one of these pixels.
float glare_share(ivec2 p, int factor) {
    vec2 share = 1.0 - abs((vec2(p) + 0.5) / float(factor) - 1.0);
    return share.x * share.y;
}

// The light of `image` in a smaller picture: sums, not averages. Outside of the picture is black.
vec4 glare_shrunk(int factor) {
    ivec2 first = glare_first(factor);
    vec4 sum = vec4(0.0);
    for (int y = 0; y < 2 * factor; ++y)
        for (int x = 0; x < 2 * factor; ++x) sum += glare_share(ivec2(x, y), factor) * image_at(first + ivec2(x, y));
    return sum;
}

// The place of a pixel in the smaller picture.
vec2 glare_grown(int factor) { return (vec2(pixel) + 0.5) / float(factor) + 1.0; }
