#include "lib/bright.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"

// The light that glows: above the threshold with a soft knee, and not brighter than the limit.
vec4 bloom_light(vec4 image, float threshold, float knee, float limit) {
    return bright_light(image, threshold, knee, limit);
}

// The weight of a texel of 6 x 6 in `bloom_shrink`. With an array Mesa would write out all 36 texels, which compiles
// longer.
float bloom_weight(ivec2 at) {
    bvec2 is_twice = equal(at / 2, ivec2(1)), is_inside = equal((at + 3) / 4, ivec2(1));
    vec2 corners = mix(vec2(1.0), vec2(2.0), is_twice);
    return corners.x * corners.y + (all(is_inside) ? 4.0 : 0.0);
}

// Halves the size: five overlapping boxes of 4 x 4 pixels, the middle one with four times the weight of the others
// (Jimenez 2014).
vec4 bloom_shrink() {
    vec4 sum = vec4(0.0);
    for (int y = 0; y < 6; ++y)
        for (int x = 0; x < 6; ++x)
            sum += bloom_weight(ivec2(x, y)) * image_at(2 * pixel + ivec2(x, y) - 2);
    return sum / 128.0;
}

vec4 bloom_box(ivec2 first) {
    vec4 sum = vec4(0.0);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 4; ++x)
            sum += image_at(first + ivec2(x, y));
    return sum / 16.0;
}

// Halves the size with the same boxes, each weighted by 1 / (1 + luminance), so that a single bright pixel does not
// flicker (Karis 2013).
vec4 bloom_shrink_steady() {
    vec4 sum = vec4(0.0);
    float total = 0.0;
    for (int i = 0; i < 5; ++i) {
        ivec2 first = i == 4 ? ivec2(-1) : 2 * ivec2(i & 1, i >> 1) - 2;
        vec4 box = bloom_box(2 * pixel + first);
        float weight = (i == 4 ? 4.0 : 1.0) / (1.0 + max(luminance(box.rgb), 0.0));
        sum += weight * box;
        total += weight;
    }
    return sum / total;
}

vec4 bloom_row(ivec2 at, vec4 across) {
    return across.x * image_at(at) + across.y * image_at(at + ivec2(1, 0)) + across.z * image_at(at + ivec2(2, 0))
        + across.w * image_at(at + ivec2(3, 0));
}

// Doubles the size: the tent filter [1 2 1] on bilinear samples of the smaller picture, which is four taps along each
// axis, in mirrored order for odd pixels. `share` of it replaces the light of this level. There are no loops, so that
// the last step can join the pass that reads it.
vec4 bloom_grow(float share) {
    const vec4 tent = vec4(1.0, 5.0, 7.0, 3.0) / 16.0;
    vec4 across = (pixel.x & 1) == 0 ? tent : tent.wzyx;
    vec4 down = (pixel.y & 1) == 0 ? tent : tent.wzyx;
    ivec2 first = (pixel + 1) / 2 - 2;
    vec4 sum = down.x * bloom_row(first, across) + down.y * bloom_row(first + ivec2(0, 1), across)
        + down.z * bloom_row(first + ivec2(0, 2), across) + down.w * bloom_row(first + ivec2(0, 3), across);
    return mix(level_at(pixel), sum, share);
}

// `fine` is the light of levels that are finer than pixels.
vec4 bloom_fine(vec4 glow, vec4 fine, float share) { return mix(glow, fine, share); }

vec4 bloom_tint(vec4 glow, vec4 tint) { return vec4(glow.rgb * tint.rgb, glow.a); }

vec4 bloom(vec4 image, vec4 glow, float intensity, int mode) {
    vec4 safe = finite(image);
    return vec4(mode == MODE_ADD ? safe.rgb + intensity * glow.rgb : mix(safe.rgb, glow.rgb, intensity), safe.a);
}
