#include "lib/display.glsl"
#include "lib/pi.glsl"

// The direction of a layer of lines: 0, 90, 45, 135, ... degrees. Each halves the largest remaining gap (van der Corput
// sequence).
float crosshatch_turn(int layer) {
    float turn = 0.0, part = 0.5;
    for (int bits = layer; bits > 0; bits >>= 1, part *= 0.5) turn += part * float(bits & 1);
    return turn * PI;
}

vec4 crosshatch(vec4 image, float size, float thickness, int layers, float angle, vec4 ink, vec4 paper) {
    image = finite(image);
    float dark = (1.0 - min(display_tone(image), 1.0)) * float(layers), covered = 0.0;
    for (int i = 0; i < 9; ++i) {
        vec2 place = (vec2(pixel) + (vec2(i % 3, i / 3) + 0.5) / 3.0) / max(finite(size), 0.5);
        for (int layer = 0; layer < min(layers, 16); ++layer) {
            float turn = finite(angle) + crosshatch_turn(layer);
            float beside = 2.0 * abs(fract(dot(place, vec2(sin(turn), cos(turn)))) - 0.5);
            if (beside < clamp(dark - float(layer), 0.0, 1.0) * finite(thickness)) {
                covered += 1.0 / 9.0;
                break;
            }
        }
    }
    vec4 color = mix(finite(paper), finite(ink), covered);
    return finite(vec4(color.rgb * color.a * image.a, image.a));
}
