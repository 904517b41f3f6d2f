#include "lib/finite.glsl"

void checker(float size, vec4 first, vec4 second, vec2 offset, out vec4 result, out float value) {
    vec2 square = floor((vec2(pixel) + 0.5 - finite(offset)) / max(finite(size), 1e-3));
    value = mod(square.x + square.y, 2.0) < 0.5 ? 0.0 : 1.0;
    result = value == 0.0 ? finite(first) : finite(second);
}
