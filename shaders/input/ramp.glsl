#include "lib/finite.glsl"
#include "lib/pi.glsl"

// The angle of v as a fraction of a turn, clockwise on the screen.
float ramp_turn(vec2 v) { return v == vec2(0.0) ? 0.0 : atan(v.y, v.x) / (2.0 * PI); }

void ramp(
    int shape, vec2 start, vec2 end, vec4 first, vec4 second, float smoothness, out vec4 result, out float value
) {
    vec2 position = vec2(pixel) + 0.5 - start * vec2(extent);
    vec2 axis = (end - start) * vec2(extent);
    float t = 0.0;
    if (shape == SHAPE_LINEAR) t = dot(position, axis) / max(dot(axis, axis), 1e-12);
    if (shape == SHAPE_RADIAL) t = length(position) / max(length(axis), 1e-6);
    if (shape == SHAPE_ANGULAR) t = fract(ramp_turn(position) - ramp_turn(axis));
    t = clamp(finite(t), 0.0, 1.0);
    value = mix(t, smoothstep(0.0, 1.0, t), finite(smoothness));
    result = mix(finite(first), finite(second), value);
}
