#include "lib/finite.glsl"

vec4 echo_first(vec4 image) { return finite(image); }

// Screen is not defined above 1: there the brighter one wins, as in `merge`.
float echo_screen(float a, float b) { return max(a, b) > 1.0 ? max(a, b) : a + b - a * b; }

// Adds one more echo to the picture.
vec4 echo_join(vec4 image, vec4 seen, float strength, int mode) {
    vec4 fainter = strength * finite(image);
    if (mode == MODE_BRIGHTEST) return max(seen, fainter);
    if (mode == MODE_ADD) return vec4(seen.rgb + fainter.rgb, min(seen.a + fainter.a, 1.0));
    if (mode == MODE_BEHIND) return seen + (1.0 - seen.a) * fainter;
    if (mode == MODE_IN_FRONT) return fainter + (1.0 - fainter.a) * seen;
    if (mode == MODE_AVERAGE) return seen + fainter;
    for (int i = 0; i < 4; ++i) seen[i] = echo_screen(seen[i], fainter[i]);
    return seen;
}

vec4 echo(vec4 seen, float total) { return finite(seen / total); }
