#include "lib/finite.glsl"

void separate_vector2(vec2 vector, out float x, out float y) {
    vector = finite(vector);
    x = vector.x, y = vector.y;
}
