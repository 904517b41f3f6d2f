#include "lib/finite.glsl"

void difference_key(
    vec4 image, vec4 clean_plate, int measure, float tolerance, float falloff, out vec4 result, out float matte
) {
    vec4 c = finite(image);
    vec3 apart = abs(c.rgb - finite(clean_plate.rgb));
    float difference = (apart.r + apart.g + apart.b) / 3.0;
    if (measure == MEASURE_LARGEST) difference = max(apart.r, max(apart.g, apart.b));
    if (measure == MEASURE_DISTANCE) difference = length(apart);
    float more = finite(difference) - finite(tolerance);
    float cover = more <= 0.0 ? 0.0 : min(more / max(finite(falloff), 1e-6), 1.0);
    result = cover * c;
    matte = cover * clamp(c.a, 0.0, 1.0);
}
