#include "lib/alpha.glsl"
#include "lib/finite.glsl"
#include "lib/hash.glsl"

const float film_grain_middle = 0.18;  // middle gray
const float film_grain_width = 0.55;  // the integral of the squared quadratic B-spline: 1 / the width of a clump

// Normally distributed numbers, mean 0 and variance 1, in clumps: nine cells under a quadratic B-spline.
vec3 film_grain_clumps(vec2 at, uvec3 stream) {
    vec2 cell = floor(at), after = at - cell, before = 1.0 - after;
    vec2 weights[3] = vec2[3](0.5 * before * before, 0.5 + after * before, 0.5 * after * after);
    vec3 sum = vec3(0.0);
    vec2 power = vec2(0.0);
    for (int y = 0; y < 3; ++y) {
        power += weights[y] * weights[y];
        for (int x = 0; x < 3; ++x)
            sum += weights[x].x * weights[y].y * normal3(ivec3(ivec2(cell) + ivec2(x, y) - 1, 0), stream);
    }
    return sum * inversesqrt(power.x * power.y);
}

vec4 film_grain(
    vec4 image, float amount, float size, float color, float shadows, float midtones, float highlights, int seed,
    bool animate
) {
    vec4 film = straight(finite(image));
    size = max(finite(size), 1e-3);
    uvec3 stream = pcg3d(uvec3(uint(seed), animate ? uint(frame) : 0u, 0u));
    vec3 grain = film_grain_clumps((vec2(pixel) + 0.5) / max(size, 1.0), stream);
    // Turns three independent numbers into three with the correlation 1 - color.
    float like = 1.0 - clamp(finite(color), 0.0, 1.0);
    vec3 common_part = vec3(grain.r + grain.g + grain.b) / 3.0;
    grain = sqrt(1.0 - like) * (grain - common_part) + sqrt(1.0 + 2.0 * like) * common_part;

    vec3 light = max(film.rgb, 0.0), rest = film_grain_middle / (light + film_grain_middle), developed = 1.0 - rest;
    vec3 tone = finite(shadows) * rest * rest + 2.0 * finite(midtones) * rest * developed
        + finite(highlights) * developed * developed;
    vec3 response = 2.0 * sqrt(rest * developed) * tone;  // 1 at middle gray
    float averaged = size / length(vec2(size, film_grain_width));  // small clumps average out within a pixel
    vec3 spread = log(2.0) * finite(amount) * averaged * response;
    film.rgb *= exp(spread * grain - 0.5 * spread * spread);
    return finite(premultiplied(film));
}
