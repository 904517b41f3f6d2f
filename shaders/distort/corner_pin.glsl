#include "lib/finite.glsl"
#include "lib/footprint.glsl"
#include "lib/sampling.glsl"

// Where a pixel reads, and whether that place lies before the horizon (z).
vec3 corner_pin_source(vec2 at, vec3 first, vec3 second, vec3 third) {
    vec3 place = vec3(at / vec2(extent), 1.0);
    float near = dot(third, place);
    vec2 uv = vec2(dot(first, place), dot(second, place)) / max(near, 1e-9);
    return vec3(clamp(uv, -1e4, 1e4) * vec2(image_size), near);
}

vec4 corner_pin(vec3 first, vec3 second, vec3 third, int kernel) {
    vec2 at = vec2(pixel) + 0.5, right = vec2(0.5, 0.0), down = right.yx;
    int n = footprint_samples(
        corner_pin_source(at + right, first, second, third).xy - corner_pin_source(at - right, first, second, third).xy,
        corner_pin_source(at + down, first, second, third).xy - corner_pin_source(at - down, first, second, third).xy
    );
    vec4 sum = vec4(0.0);
    for (int i = 0; i < n * n; ++i) {
        vec3 place = corner_pin_source(at + footprint_at(i, n), first, second, third);
        if (place.z > 1e-9) sum += image_filtered(place.xy, kernel);
    }
    return finite(sum / float(n * n));
}
