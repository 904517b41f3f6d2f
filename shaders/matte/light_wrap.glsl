#include "lib/finite.glsl"

// The light of the background that the subject does not cover.
vec4 light_wrap_beside(vec4 image, vec4 background) {
    return vec4(finite(background.rgb) * (1.0 - clamp(finite(image.a), 0.0, 1.0)), 0.0);
}

vec4 light_wrap_light(vec4 image, vec4 spread, float intensity) {
    return vec4(finite(finite(intensity) * clamp(finite(image.a), 0.0, 1.0) * finite(spread.rgb)), 0.0);
}

vec4 light_wrap(vec4 image, vec4 light) { return finite(image) + light; }
