#include "lib/finite.glsl"

void separate_vector4(vec4 vector, out float x, out float y, out float z, out float w) {
    vector = finite(vector);
    x = vector.x, y = vector.y, z = vector.z, w = vector.w;
}
