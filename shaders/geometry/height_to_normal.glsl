#include "lib/finite.glsl"

// The difference of two neighbors along an axis, per pixel, in a row beside this one.
float height_to_normal_slope(ivec2 along, ivec2 beside) {
    return 0.5 * (height_at(pixel + along + beside) - height_at(pixel - along + beside));
}

vec3 height_to_normal(float depth, int kernel, int green) {
    const ivec2 right = ivec2(1, 0), down = ivec2(0, 1), here = ivec2(0);
    vec2 slope = vec2(height_to_normal_slope(right, here), height_to_normal_slope(down, here));
    if (kernel == KERNEL_SOBEL) {
        slope.x = 0.5 * slope.x + 0.25 * (height_to_normal_slope(right, down) + height_to_normal_slope(right, -down));
        slope.y = 0.5 * slope.y + 0.25 * (height_to_normal_slope(down, right) + height_to_normal_slope(down, -right));
    }
    slope = finite(depth * slope);
    return normalize(vec3(-slope.x, green == GREEN_UP ? slope.y : -slope.y, 1.0));
}

vec4 height_to_normal_color(vec3 normal) { return vec4(0.5 + 0.5 * normal, 1.0); }
