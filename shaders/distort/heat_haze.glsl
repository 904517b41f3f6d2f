#include "lib/finite.glsl"
#include "lib/noise.glsl"

const float heat_haze_reach = 65536.0;  // more pixels than any picture has: keeps wild masks within the range of int

// `rise` is in pixels per frame, `change` in periods of the noise per frame.
vec4 heat_haze(float amount, vec2 swirl, float rise, float change, int seed) {
    vec2 at = vec2(pixel) + 0.5;
    vec3 place = vec3((at + vec2(0.0, rise * float(frame))) / swirl, change * float(frame));
    vec3 coarse = gradient_noise(place, uvec3(uint(seed), 0u, 0u));
    vec3 fine = gradient_noise(place * vec3(2.0, 2.0, 1.0), uvec3(uint(seed), 1u, 0u));
    vec2 push = amount * (2.0 * coarse.xy + fine.xy) / 3.0;
    float hot = finite(heat_at(clamp(pixel, ivec2(0), heat_size - 1)));
    return image_near(at + clamp(hot * push, -heat_haze_reach, heat_haze_reach));
}
