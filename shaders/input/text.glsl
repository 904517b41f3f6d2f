// Letters over a picture. Their coverage comes from lib/paths.glsl.

#include "lib/paths.glsl"

vec4 text_below(vec4 image) { return finite(image); }

vec4 text_over(vec4 image, float cover, vec4 color) {
    vec4 letter = finite(color) * cover;
    return letter + image * (1.0 - letter.a);
}
