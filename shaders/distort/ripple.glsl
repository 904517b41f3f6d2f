#include "lib/finite.glsl"
#include "lib/footprint.glsl"
#include "lib/pi.glsl"

// Where a pixel reads. `wave` holds the amplitude, the wavelength, the phase, and the distance at which the wave fades
// to 1 / e.
vec2 ripple_source(vec2 at, int shape, int motion, float angle, vec2 center, vec4 wave) {
    vec2 away = at - center, along = vec2(cos(angle), sin(angle));
    float run = dot(away, along);
    if (shape == SHAPE_CIRCULAR) {
        run = length(away);
        along = run > 0.0 ? away / run : vec2(0.0);
    }
    float height = wave.x * sin(2.0 * PI * (run / wave.y - wave.z)) * exp(-abs(run) / wave.w);
    return at + height * (motion == MOTION_ALONG ? along : vec2(-along.y, along.x));
}

vec4 ripple(int shape, int motion, float angle, vec2 center, vec4 wave) {
    vec2 at = vec2(pixel) + 0.5, right = vec2(0.5, 0.0), down = right.yx;
    int n = footprint_samples(
        ripple_source(at + right, shape, motion, angle, center, wave)
            - ripple_source(at - right, shape, motion, angle, center, wave),
        ripple_source(at + down, shape, motion, angle, center, wave)
            - ripple_source(at - down, shape, motion, angle, center, wave)
    );
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i)
        sum += image_near(ripple_source(at + footprint_at(i, n), shape, motion, angle, center, wave));
    return finite(sum / float(n * n));
}
