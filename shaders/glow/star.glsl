#include "lib/bright.glsl"

vec4 star_light(vec4 image, float threshold, float knee, float limit) {
    return bright_light(image, threshold, knee, limit);
}

// Rotates the picture around its center, counterclockwise. Bilinear, since sharper filters make negative light.
vec4 star_turn(float angle) {
    vec2 at = vec2(pixel) + 0.5 - 0.5 * vec2(extent);
    return image_near(mat2(cos(angle), sin(angle), -sin(angle), cos(angle)) * at + 0.5 * vec2(image_size));
}

vec4 star_cross(vec4 u, vec4 v) { return 0.5 * (u + v); }

vec4 star_glow(vec4 image, vec4 arms, vec4 tint) { return glow_alone(image, arms.rgb * tint.rgb); }

vec4 star(vec4 image, vec4 glow, float intensity) { return with_glow(image, intensity * glow.rgb); }
