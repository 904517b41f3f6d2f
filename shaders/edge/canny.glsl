#include "lib/display.glsl"

const float canny_none = 0.0, canny_weak = 0.5, canny_strong = 1.0;
const float canny_tan22 = 0.41421356;  // tan(22.5 degrees): the border between two of the four directions

float canny_tone(vec4 image) { return display_tone(image); }

// The Sobel gradient, scaled so that a step of 1 along a row or column gives 1.
vec2 canny_gradient(int spacing, float gain) {
    ivec2 right = ivec2(spacing, 0), down = ivec2(0, spacing);
    float falling = tone_at(pixel + right + down) - tone_at(pixel - right - down);
    float rising = tone_at(pixel + right - down) - tone_at(pixel - right + down);
    return gain * vec2(
        2.0 * (tone_at(pixel + right) - tone_at(pixel - right)) + falling + rising,
        2.0 * (tone_at(pixel + down) - tone_at(pixel - down)) + falling - rising
    ) / 4.0;
}

// Thins edges: a pixel counts if both neighbors across the edge are weaker (non-maximum suppression, Canny 1986). Of
// two equal neighbors one stays.
float canny_ridge(float low, float high) {
    vec2 here = gradient_at(pixel), size = abs(here);
    float strength = length(here);
    if (strength <= low) return canny_none;
    ivec2 across = ivec2(here.x * here.y < 0.0 ? -1 : 1, 1);
    if (size.y < canny_tan22 * size.x) across = ivec2(1, 0);
    else if (size.x < canny_tan22 * size.y) across = ivec2(0, 1);
    float before = length(gradient_at(pixel - across)), after = length(gradient_at(pixel + across));
    bool diagonal = across.x * across.y != 0;
    if (strength <= before || strength < after || (diagonal && strength == after)) return canny_none;
    return strength > high ? canny_strong : canny_weak;
}

// Hysteresis: weak pixels become strong if at most three weak pixels lie between them and a strong one. The rows of a 7
// x 7 window are bits of integers.
float canny_follow() {
    float here = state_at(pixel);
    if (here != canny_weak) return here;
    uint lines[7], strong[7];
    for (int y = 0; y < 7; ++y) {
        lines[y] = strong[y] = 0u;
        for (int x = 0; x < 7; ++x) {
            float state = state_at(pixel + ivec2(x, y) - 3);
            if (state != canny_none) lines[y] |= 1u << uint(x);
            if (state == canny_strong) strong[y] |= 1u << uint(x);
        }
    }
    for (int i = 0; i < 3; ++i)
        for (int y = 0; y < 7; ++y) {
            uint near = strong[y] | strong[max(y - 1, 0)] | strong[min(y + 1, 6)];
            strong[y] |= (near | near << 1u | near >> 1u) & lines[y];
        }
    return (strong[3] >> 3u & 1u) == 1u ? canny_strong : canny_weak;
}

float canny_lines(float state, float cover) { return state == canny_strong ? cover : 0.0; }

// Lines `width` pixels wide, along one axis.
float canny_wide(ivec2 along, int width) {
    float most = 0.0;
    for (int i = 0; i < width; ++i) most = max(most, thin_at(pixel + (i - width / 2) * along));
    return most;
}

float canny_columns(int width) { return canny_wide(ivec2(0, 1), width); }

float canny_rows(int width) { return canny_wide(ivec2(1, 0), width); }

vec4 canny(vec4 image, float lines) {
    float alpha = finite(image.a);
    return vec4(vec3(lines * alpha), alpha);
}
