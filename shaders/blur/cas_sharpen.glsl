#include "lib/finite.glsl"

vec3 cas_sharpen_at(int x, int y) { return finite(image_at(pixel + ivec2(x, y))).rgb; }

// CasFilter of ffx_cas.h with its defines for better diagonals and for slow, without scaling.
vec4 cas_sharpen(float sharpness) {
    vec3 up = cas_sharpen_at(0, -1), left = cas_sharpen_at(-1, 0), right = cas_sharpen_at(1, 0);
    vec3 down = cas_sharpen_at(0, 1), middle = cas_sharpen_at(0, 0);
    vec3 least = min(min(min(left, middle), min(right, up)), down);
    vec3 most = max(max(max(left, middle), max(right, up)), down);
    vec3 upper_left = cas_sharpen_at(-1, -1), upper_right = cas_sharpen_at(1, -1);
    vec3 lower_left = cas_sharpen_at(-1, 1), lower_right = cas_sharpen_at(1, 1);
    least += min(min(min(upper_left, upper_right), min(lower_left, lower_right)), least);
    most += max(max(max(upper_left, upper_right), max(lower_left, lower_right)), most);
    // The smaller distance to black or white, relative to the brightest neighbor, says how much is safe to add.
    vec3 safe = sqrt(clamp(min(least, 2.0 - most) / max(most, 1e-6), 0.0, 1.0));
    vec3 weight = -safe / mix(8.0, 5.0, clamp(finite(sharpness), 0.0, 1.0));
    vec3 sharp = (weight * (up + left + right + down) + middle) / (1.0 + 4.0 * weight);
    return vec4(mix(middle, clamp(sharp, 0.0, 1.0), greaterThan(safe, vec3(0.0))), finite(image_at(pixel)).a);
}
