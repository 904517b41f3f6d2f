#include "lib/alpha.glsl"
#include "lib/color.glsl"
#include "lib/finite.glsl"
#include "lib/hash.glsl"

vec3 tv_snow_line(ivec2 cell, int moment, uvec3 stream) {
    vec3 sum = vec3(0.0);
    for (int tap = -1; tap <= 1; ++tap)
        sum += (tap == 0 ? 0.5 : 0.25) * hash3(ivec3(cell.x + tap, cell.y, moment), stream);
    return sum;
}

vec4 tv_snow(
    vec4 image, float amount, int mode, float size, float contrast, float lines, float color, bool interlaced, int hold,
    int seed
) {
    vec4 picture = straight(finite(image));
    size = max(finite(size), 1e-3);
    ivec2 cell = ivec2((vec2(pixel) + 0.5) / max(size, 1.0));
    int moment = int(floor(float(frame) / float(max(hold, 1))));
    if (interlaced) moment = (moment + (cell.y & 1)) >> 1;  // lines of the other field change in the next frame
    vec3 flakes = tv_snow_line(cell, moment, pcg3d(uvec3(uint(seed), 0u, 0u))) - 0.5;
    flakes = mix(vec3(flakes.x), flakes, clamp(finite(color), 0.0, 1.0));
    float level = hash3(ivec3(cell.y, moment, 0), pcg3d(uvec3(uint(seed), 1u, 0u))).x - 0.5;
    float fine = min(size, 1.0);  // a pixel averages 1 / fine lines, and as many flakes in each
    flakes *= fine;
    level *= sqrt(fine) * clamp(finite(lines), 0.0, 1.0);
    vec3 snow = clamp(0.5 + finite(contrast) * (flakes + level), 0.0, 1.0);

    vec3 code = srgb_encode(picture.rgb);
    float share = clamp(finite(amount), 0.0, 1.0);
    code = mode == MODE_MIX ? mix(code, snow, share) : code * (1.0 + share * (2.0 * snow - 1.0));
    return finite(premultiplied(vec4(srgb_decode(code), picture.a)));
}
