#include "lib/color.glsl"
#include "lib/finite.glsl"

// The weight of the two outer rows when the derivative is smoothed across. All three rows sum to 1.
float edge_detect_side(int operator) {
    return operator == OPERATOR_SOBEL ? 1.0 / 4.0 : operator == OPERATOR_SCHARR ? 3.0 / 16.0 : 1.0 / 3.0;
}

vec3 edge_detect_light(ivec2 away) { return image_at(pixel + away).rgb; }

// The change of light to the right and down. A Laplacian has no direction: all of it is in `across`.
void edge_detect_change(int operator, int spacing, out vec3 across, out vec3 down) {
    vec3 left = edge_detect_light(spacing * ivec2(-1, 0)), right = edge_detect_light(spacing * ivec2(1, 0));
    vec3 above = edge_detect_light(spacing * ivec2(0, -1)), below = edge_detect_light(spacing * ivec2(0, 1));
    if (operator == OPERATOR_LAPLACE) {
        across = left + right + above + below - 4.0 * edge_detect_light(spacing * ivec2(0, 0));
        down = vec3(0.0);
        return;
    }
    vec3 rising = edge_detect_light(spacing * ivec2(1, -1)) - edge_detect_light(spacing * ivec2(-1, 1));
    vec3 falling = edge_detect_light(spacing * ivec2(1, 1)) - edge_detect_light(spacing * ivec2(-1, -1));
    float side = edge_detect_side(operator), middle = 1.0 - 2.0 * side;
    across = middle * (right - left) + side * (falling + rising);
    down = middle * (below - above) + side * (falling - rising);
}

vec3 edge_detect_strength(int operator, int channels, float strength, float threshold, int spacing) {
    vec3 across, down;
    edge_detect_change(operator, spacing, across, down);
    vec3 size = channels == CHANNELS_LUMINANCE ? vec3(length(vec2(luminance(across), luminance(down))))
                                               : sqrt(across * across + down * down);
    return finite(strength * max(size - threshold, 0.0));
}

vec4 edge_detect(int operator, int channels, float strength, float threshold, int spacing) {
    return vec4(edge_detect_strength(operator, channels, strength, threshold, spacing), image_at(pixel).a);
}

float edge_detect_magnitude(int operator, int channels, float strength, float threshold, int spacing) {
    return largest(edge_detect_strength(operator, channels, strength, threshold, spacing));
}
