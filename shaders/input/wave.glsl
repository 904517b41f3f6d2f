#include "lib/finite.glsl"
#include "lib/noise.glsl"
#include "lib/pi.glsl"

void wave(
    int pattern, int profile, float wavelength, float angle, float phase, vec2 center, float distortion, float size,
    int seed, out vec4 result, out float value
) {
    vec2 at = vec2(pixel) + 0.5, away = at - finite(center) * vec2(extent);
    float way = pattern == PATTERN_RINGS ? length(away) : dot(away, vec2(cos(angle), sin(angle)));
    float bend = finite(distortion) * simplex_noise(vec3(at / max(finite(size), 1e-3), 0.0), uvec3(uint(seed), 0u, 0u)).x;
    float turn = way / max(finite(wavelength), 1e-3) - finite(phase) + bend;
    float t = turn - floor(turn);
    value = 0.5 - 0.5 * cos(2.0 * PI * t);
    if (profile == PROFILE_TRIANGLE) value = 1.0 - abs(2.0 * t - 1.0);
    if (profile == PROFILE_SAW) value = t;
    if (profile == PROFILE_SQUARE) value = t < 0.5 ? 0.0 : 1.0;
    value = finite(value);
    result = vec4(vec3(value), 1.0);
}
