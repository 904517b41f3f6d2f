// Letters over a picture. Their coverage comes from lib/paths.glsl.

#include "lib/paths.glsl"

vec4 text_below(vec4 image) { return finite(image); }

vec4 text_over(vec4 image, float cover, vec4 color) {
    vec4 letter = finite(color) * cover;
    return letter + image * (1.0 - letter.a);
}

// Letters with a line around them: its outer edge is as far from their outlines as it is wide.
float text_stroke(float cover, vec2 nearest, float width) {
    float inside = cover >= 0.5 ? nearest.x : -nearest.x;
    return max(cover, clamp(inside + width + 0.5, 0.0, 1.0));
}
