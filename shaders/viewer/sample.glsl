#include "lib/finite.glsl"

// A picture at one pixel of a panel: the nearest texel, or the mean of all texels that the pixel covers. `part` is the
// first texel in the texture, and the size of the picture's frame. A texture may hold less than the frame, or go on
// beyond it: then its first texel is below 0. A pixel with missing texels counts as outside.

struct Sampled {
    vec4 value;
    bool inside, broken;  // broken: some texel is NaN or infinite; the value is the mean of the others
};

// The most texels that are read along a side for one pixel; if there are more, every n-th is read.
const int MOST = 8;

void sampled_texel(sampler2D picture, ivec2 at, float weight, inout vec4 sum, inout float total, inout bool broken) {
    vec4 texel = texelFetch(picture, at, 0);
    if (is_finite(texel)) {
        sum += weight * texel;
        total += weight;
    } else {
        broken = true;
    }
}

Sampled sampled(sampler2D picture, ivec4 part, vec2 origin, vec2 texels, int components, vec2 at) {
    vec2 start = vec2(min(part.xy, 0)), end = vec2(max(part.zw, part.xy + textureSize(picture, 0)));
    vec2 center = (at - origin) * texels;
    Sampled texel = Sampled(vec4(0.0), all(greaterThanEqual(center, start)) && all(lessThan(center, end)), false);
    float total = 0.0;
    if (texel.inside) {
        vec2 low = max(center - 0.5 * texels, start), high = min(center + 0.5 * texels, end);
        bvec2 enlarged = lessThanEqual(texels, vec2(1.0));
        ivec2 first = ivec2(floor(mix(low, center, enlarged)));
        ivec2 last = ivec2(floor(mix(ceil(high) - 1.0, center, enlarged)));
        ivec2 stride = max((last - first + MOST) / MOST, 1);
        texel.inside = all(greaterThanEqual(first, part.xy)) && all(lessThan(last, part.xy + textureSize(picture, 0)));
        if (!texel.inside) last = first - 1;
        for (int y = first.y; y <= last.y; y += stride.y)
            for (int x = first.x; x <= last.x; x += stride.x) {
                vec2 covered = min(high, vec2(x, y) + 1.0) - max(low, vec2(x, y));
                vec2 weight = mix(covered, vec2(1.0), enlarged);
                sampled_texel(picture, ivec2(x, y) - part.xy, weight.x * weight.y, texel.value, total, texel.broken);
            }
    }
    texel.value = total > 0.0 ? texel.value / total : vec4(0.0);
    if (components == 1) texel.value = texel.value.rrrr;
    if (components < 4) texel.value.a = 1.0;
    return texel;
}

// Whether a pixel of a panel shows what lies around the frame of a picture.
bool beyond_frame(ivec4 part, vec2 origin, vec2 texels, vec2 at) {
    vec2 center = (at - origin) * texels;
    return any(lessThan(center, vec2(0.0))) || any(greaterThanEqual(center, vec2(part.zw)));
}
