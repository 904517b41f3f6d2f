// Filters for resampling, by distance in pixels. They are not normalized: divide by the sum of the weights.
#include "lib/pi.glsl"

// The triangle filter: linear interpolation.
float triangle_weight(float x) { return max(1.0 - abs(x), 0.0); }

// The cubic filters of Mitchell and Netravali (1988): B 0 and C 1/2 is Catmull-Rom, B and C 1/3 is Mitchell's.
float cubic_weight(float x, float b, float c) {
    x = abs(x);
    if (x >= 2.0) return 0.0;
    vec4 powers = vec4(x * x * x, x * x, x, 1.0);
    vec4 near = vec4(12.0 - 9.0 * b - 6.0 * c, -18.0 + 12.0 * b + 6.0 * c, 0.0, 6.0 - 2.0 * b);
    vec4 far = vec4(-b - 6.0 * c, 6.0 * b + 30.0 * c, -12.0 * b - 48.0 * c, 8.0 * b + 24.0 * c);
    return dot(powers, x < 1.0 ? near : far) / 6.0;
}

// A sinc windowed by the main lobe of a wider sinc (Lanczos; Duchon 1979).
float lanczos_weight(float x, float lobes) {
    if (abs(x) >= lobes) return 0.0;
    if (abs(x) < 1e-4) return 1.0;
    return lobes * sin(PI * x) * sin(PI * x / lobes) / (PI * PI * x * x);
}
